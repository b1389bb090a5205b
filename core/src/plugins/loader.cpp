#include "plugins/loader.hpp"

#include <dlfcn.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include <boost/dll/runtime_symbol_info.hpp>
#include <boost/dll/shared_library.hpp>
#include <cctype>
#include <cstring>
#include <deque>
#include <mutex>

#include "grit/error.hpp"
#include "plugins/boundary.hpp"
#include "plugins/build_facts.hpp"
#include "plugins/elf_file.hpp"

namespace grit {
namespace {

using Library = boost::dll::shared_library;

/// Text of fixed size; an unknown file may lack the terminating zero.
template <std::size_t N>
std::string text(const char (&field)[N]) {
  std::string result;
  for (std::size_t i = 0; i < N && field[i] != 0; ++i)
    result += std::isprint(static_cast<unsigned char>(field[i])) ? field[i] : '?';
  return '"' + result + '"';
}
std::string text(const char* member) { return '"' + std::string(member == nullptr ? "" : member) + '"'; }
std::string text(std::uint32_t number) { return std::to_string(number); }
std::string text(const Layout& layout) {
  return std::to_string(layout.size) + " bytes aligned to " + std::to_string(layout.alignment);
}

/// The CMake package of the SDK: lib/cmake/grit, if this library is in lib/grit of a build folder or in
/// lib/grit/<instruction set> of an installation.
std::string sdk_package() {
  const auto above = library_directory().parent_path();
  return ((above.filename() == "grit" ? above.parent_path() : above) / "cmake/grit").string();
}

std::string rebuild() {
  return "rebuild it against this SDK: cmake --fresh -S SOURCES -B BUILD -Dgrit_DIR=" + sdk_package() +
         " -DGRIT_ARCH=" + build_facts().arch + " && cmake --build BUILD --clean-first";
}

/// Whether calls since construction have changed how floating-point numbers are computed. What is linked with
/// -ffast-math sets subnormal numbers to zero, in the whole process, when it is opened. Changes are undone.
class ArithmeticWatch {
 public:
  ~ArithmeticWatch() { undo(); }
#ifdef __SSE__
  bool undo() {
    // Of the control register: flags of past operations are no settings.
    constexpr unsigned flags = 0x3f;
    const bool changed = ((_mm_getcsr() ^ before_) & ~flags) != 0;
    if (changed) _mm_setcsr(before_);
    return changed;
  }

 private:
  unsigned before_ = _mm_getcsr();
#else
  bool undo() { return false; }
#endif
};

/// Keeps a library open until the process ends, intentionally beyond the destructors of static objects: objects,
/// exceptions and virtual tables of a plugin may be referenced anywhere, and their code must outlive them.
const Library& keep(Library library) {
  static std::mutex mutex;
  static auto& kept = *new std::deque<Library>;
  const std::lock_guard lock(mutex);
  return kept.emplace_back(std::move(library));
}

}  // namespace

std::filesystem::path library_file() {
  static const char here = 0;
  std::error_code none;
  return std::filesystem::weakly_canonical(boost::dll::symbol_location_ptr(&here, none));
}
std::filesystem::path library_directory() { return library_file().parent_path(); }

std::vector<std::string> mismatches(const BuildTag& expected, const BuildTag& found) {
  std::vector<std::string> all;
  const auto compare = [&](const char* what, const auto& ours, const auto& theirs) {
    if (text(ours) != text(theirs))
      all.push_back(std::string(what) + ": expected " + text(ours) + ", found " + text(theirs));
  };
  compare("magic", expected.magic, found.magic);
  if (!all.empty()) return all;
  compare("size of the build tag", expected.tag_size, found.tag_size);
  if (!all.empty()) return all;
  compare("SDK version", expected.sdk_version, found.sdk_version);
  compare("compiler", expected.compiler, found.compiler);
  compare("C++ library", expected.library_abi, found.library_abi);
  compare("instruction set", expected.instruction_set, found.instruction_set);
  compare("Row", expected.row, found.row);
  compare("ContactRow", expected.contact_row, found.contact_row);
  compare("BodySum", expected.body_sum, found.body_sum);
  compare("PairBatch", expected.pair_batch, found.pair_batch);
  compare("WallBatch", expected.wall_batch, found.wall_batch);
  return all;
}

const PluginInfo& load_plugin(const std::filesystem::path& file, const Kind& kind, const std::string& name) {
  const std::string title = std::string(kind.name) + " plugin \"" + name + "\" (" + file.string() + ")";
  const auto refuse = [&](const std::string& reason, const std::string& remedy) {
    return PluginError(title + ": " + reason + "\n  " + remedy);
  };

  if (const std::string fault = elf_fault(file); !fault.empty())
    throw refuse(fault, "copy or build the file again, for this machine");
  ArithmeticWatch arithmetic;
  Library opened;
  std::error_code failed;
  opened.load(file, failed, boost::dll::load_mode::rtld_now | boost::dll::load_mode::rtld_local);
  if (failed) {
    const char* const reason = ::dlerror();  // more specific than the error code, which is always the same
    throw refuse("cannot be opened: " + (reason != nullptr ? reason : failed.message()),
                 "build it with the function grit_plugin of the CMake package in " + sdk_package() + "; `ldd -r " +
                     file.string() + "` lists undefined symbols");
  }
  const Library& library = keep(std::move(opened));
  if (arithmetic.undo())
    throw refuse("changes the arithmetic of the process, as files do that are linked with -ffast-math",
                 "link it without -ffast-math, -Ofast and -funsafe-math-optimizations");
  if (!library.has(plugin_entry_name))
    throw refuse(std::string("has no function ") + plugin_entry_name,
                 std::string("define extern \"C\" const grit::PluginInfo* ") + plugin_entry_name +
                     "() as declared in grit/plugin.hpp, or remove the file");

  const PluginEntry entry = &library.get<const PluginInfo*()>(plugin_entry_name);
  const PluginInfo* info = at_boundary(title, plugin_entry_name + std::string("()"), entry);
  if (info == nullptr)
    throw refuse(std::string("its ") + plugin_entry_name + "() returned null",
                 "return the address of a static PluginInfo");

  const BuildTag expected = build_tag();
  if (const auto different = mismatches(expected, info->tag); !different.empty()) {
    std::string list = std::memcmp(expected.magic, info->tag.magic, sizeof expected.magic) != 0
                           ? "is not a plugin of grit"
                           : "was built differently from this program";
    for (const auto& one : different) list += "\n  " + one;
    throw refuse(list, rebuild());
  }
  if (text(info->kind) != text(kind.name))
    throw refuse("kind: expected " + text(kind.name) + " of a file in " + kind.folder + "/, found " + text(info->kind),
                 "move the file to the folder of its kind, or set PluginInfo::kind to " + text(kind.name));
  if (text(info->name) != text(name.c_str()))
    throw refuse("name: expected " + text(name.c_str()) + " as in the file name, found " + text(info->name),
                 "rename the file, or set PluginInfo::name to " + text(name.c_str()));
  if (!kind.has_maker(*info))
    throw refuse(std::string("cannot create objects: PluginInfo::make_") + kind.name + " is null",
                 std::string("set make_") + kind.name + " to a function that returns a new object");
  return *info;
}

}  // namespace grit
