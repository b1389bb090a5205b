#include "storage/hdf5.hpp"

#include <hdf5.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <optional>
#include <sstream>
#include <string_view>

#include "format/resources.hpp"
#include "format/utf8.hpp"
#include "grit/description.hpp"
#include "grit/error.hpp"
#include "storage/seal.hpp"

namespace grit::hdf5 {
namespace {

static_assert(std::same_as<hid_t, std::int64_t> && std::same_as<herr_t, int>);

// 2 · 128 chunks fit one node of the index: for half a million samples it is not split, and so never partly rewritten.
constexpr unsigned chunk_index_half = 128;
// Growth increment of a copy in memory.
constexpr std::size_t copy_increment = std::size_t{1} << 16;
// Block size of a checksum.
constexpr std::size_t checked_bytes = std::size_t{1} << 20;

/// Address space, which costs no memory. libhdf5 may crash where memory ends. So none of its work begins without as
/// much to spare, and if there is not, this much is released for closing what is open.
class Reserve {
 public:
  Reserve() : kept_(map()) {}

  /// Throws std::bad_alloc if memory has ended.
  void demand() {
    if (can_take(bytes)) return;
    if (void* const kept = kept_.exchange(nullptr)) unmap(kept);
    throw std::bad_alloc();
  }

 private:
  static constexpr std::size_t bytes = std::size_t{1} << 24;
  static void* map() {
    void* const memory = ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    return memory == MAP_FAILED ? nullptr : memory;
  }
  static void unmap(void* memory) { ::munmap(memory, bytes); }

  std::atomic<void*> kept_;
};

void demand_memory() {
  static Reserve reserve;
  reserve.demand();
}

/// The library's innermost message, which is closest to the cause. For failed system calls, the system's message.
std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned depth, const H5E_error2_t* error, void* out) -> herr_t {
        if (depth == 0 && error->desc) *static_cast<std::string*>(out) = error->desc;
        return 0;
      },
      &text);
  constexpr std::string_view mark = "error message = '";
  if (const auto found = text.find(mark); found != std::string::npos) {
    const auto from = found + mark.size();
    const auto system = text.substr(from, text.find('\'', from) - from);
    text = text.substr(0, text.find(':')) + ": " + system;
  }
  return text.empty() ? "HDF5 gives no reason" : text;
}

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw FileError(where + ": cannot " + what + ": " + reason());
}

std::string child(const std::string& where, const std::string& name) { return where + '/' + name; }

template <class Result>
Result checked(Result result, const std::string& where, const std::string& what) {
  if (result < 0) fail(where, what);
  return result;
}

Handle owned(hid_t id, Handle::Close close, const std::string& where, const std::string& what) {
  return {checked(id, where, what), close};
}

hid_t native(Number type) {
  switch (type) {
    case Number::float64:
      return H5T_NATIVE_DOUBLE;
    case Number::float32:
      return H5T_NATIVE_FLOAT;
    case Number::int64:
      return H5T_NATIVE_INT64;
    case Number::int32:
      return H5T_NATIVE_INT32;
    case Number::uint64:
      return H5T_NATIVE_UINT64;
    case Number::uint32:
      return H5T_NATIVE_UINT32;
    case Number::uint8:
      break;
  }
  return H5T_NATIVE_UINT8;
}

/// Conversions of other types have read beyond their buffers in damaged files.
bool is_number_of_grit(hid_t type) {
  constexpr std::array all{Number::float64, Number::float32, Number::int64, Number::int32,
                           Number::uint64,  Number::uint32,  Number::uint8};
  return std::ranges::any_of(all, [type](Number one) { return H5Tequal(type, native(one)) > 0; });
}

/// Length of the file of an object [bytes].
hsize_t length_of_file(hid_t object, const std::string& where) {
  const auto file = owned(H5Iget_file_id(object), H5Fclose, where, "find the file");
  hsize_t length = 0;
  checked(H5Fget_filesize(file.id(), &length), where, "find the length of the file");
  return length;
}

/// A single value, not a list, which would not fit into the memory of one.
void check_scalar(hid_t attribute, const std::string& where, const std::string& name) {
  const auto extent = owned(H5Aget_space(attribute), H5Sclose, where, "read attribute '" + name + "'");
  if (H5Sget_simple_extent_npoints(extent.id()) != 1)
    throw FileError(where + ": attribute '" + name + "' is not a single value; the file is damaged or not of grit");
}

/// Refuses links, which may lead out of the file.
void check_link(hid_t group, const std::string& name, const std::string& where) {
  H5L_info_t link{};
  checked(H5Lget_info(group, name.c_str(), &link, H5P_DEFAULT), where, "open");
  if (link.type != H5L_TYPE_HARD)
    throw FileError(where +
                    ": is a link to another object or file; grit does not write these, and does not follow them");
}

/// Refuses data outside the file and filters, which are libraries, except for checksums.
void check_storage(hid_t dataset, const std::string& where) {
  const auto creation = owned(H5Dget_create_plist(dataset), H5Pclose, where, "read the layout");
  const auto layout = H5Pget_layout(creation.id());
  if ((layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) ||
      H5Pget_external_count(creation.id()) != 0)
    throw FileError(where + ": its data are in other files; grit does not write these, and does not read them");
  for (int i = 0, filters = H5Pget_nfilters(creation.id()); i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    if (H5Pget_filter2(creation.id(), static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, nullptr) !=
        H5Z_FILTER_FLETCHER32)
      throw FileError(where + ": is compressed or filtered; grit does not write this. Write it without filters");
  }
}

std::vector<hsize_t> lengths(const Shape& shape) { return {shape.begin(), shape.end()}; }

Handle space(const Shape& shape, const std::string& where) {
  const auto dims = lengths(shape);
  return owned(
      dims.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr),
      H5Sclose, where, "describe a shape");
}

/// Space of the file with rows [first, first + count) selected.
Handle rows_of(hid_t dataset, const Shape& shape, std::size_t first, std::size_t count, const std::string& where) {
  auto file = owned(H5Dget_space(dataset), H5Sclose, where, "read the shape");
  std::vector<hsize_t> start(shape.size(), 0), size = lengths(shape);
  start[0] = first, size[0] = count;
  checked(H5Sselect_hyperslab(file.id(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr), where,
          "select rows");
  return file;
}

/// The version of the first block of a file: from 3 on, all metadata has checksums. Nothing for other files.
std::optional<unsigned> version_of(const std::filesystem::path& path) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, 9> first{};
  if (!std::ifstream(path, std::ios::binary).read(first.data(), first.size()) ||
      std::string_view(first.data(), signature.size()) != signature)
    return std::nullopt;
  return static_cast<unsigned char>(first.back());
}

/// Before the library sees a file that exists.
void check_kind(const std::filesystem::path& path, Mode mode) {
  constexpr unsigned with_checksums = 3;
  std::error_code missing;
  if (mode == Mode::replace || mode == Mode::write_whole || !std::filesystem::exists(path, missing)) return;
  if (!std::filesystem::is_regular_file(path, missing)) throw FileError(path.string() + ": is not a file");
  if (const auto version = version_of(path); mode == Mode::read_whole && version && *version < with_checksums)
    throw FileError(path.string() + ": is of an earlier version of grit, without checksums; run the description again");
}

hid_t open_file(const std::filesystem::path& path, Mode mode) {
  demand_memory();
  // A file that could not be closed because of a full disk would be closed again at exit, which crashes. All other
  // files are closed by then. Must be called before any other function of the library.
  static const herr_t no_cleanup = H5dont_atexit();
  // A file may name filters; the library would load them from folders for all users.
  static const herr_t no_filters = H5PLset_loading_state(0);
  static_cast<void>(no_cleanup), static_cast<void>(no_filters);
  check_kind(path, mode);
  // The setting is per thread in a thread-safe HDF5, hence set for every file.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const auto where = path.string();
  const auto access = owned(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, where, "prepare to open");
  H5Pset_fclose_degree(access.id(), H5F_CLOSE_STRONG);
  H5Pset_file_locking(access.id(), false, true);
  // Metadata that the cache writes back at any time would corrupt the file of a run killed between two flushes.
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  H5Pget_mdc_config(access.id(), &cache);
  cache.evictions_enabled = mode == Mode::read || mode == Mode::read_whole || mode == Mode::copy;
  if (!cache.evictions_enabled) {
    cache.incr_mode = H5C_incr__off;
    cache.flash_incr_mode = H5C_flash_incr__off;
    cache.decr_mode = H5C_decr__off;
  }
  checked(H5Pset_mdc_config(access.id(), &cache), where, "prepare to open");
  if (mode == Mode::copy) checked(H5Pset_fapl_core(access.id(), copy_increment, false), where, "prepare to open");
  switch (mode) {
    case Mode::read:
    case Mode::read_whole:
    case Mode::copy:
      return checked(H5Fopen(where.c_str(), H5F_ACC_RDONLY, access.id()), where, "read");
    case Mode::change: {
      unseal(path);
      Handle file = owned(H5Fopen(where.c_str(), H5F_ACC_RDWR, access.id()), H5Fclose, where, "change");
      // A flush writes the file length last: a writer killed during a flush may have left it too short.
      checked(H5Fincrement_filesize(file.id(), 0), where, "change");
      return file.release();
    }
    case Mode::replace:
    case Mode::write_whole:
      break;
  }
  const auto creation = owned(H5Pcreate(H5P_FILE_CREATE), H5Pclose, where, "prepare to create");
  if (mode == Mode::write_whole)
    checked(H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110), where, "prepare to create");
  else checked(H5Pset_istore_k(creation.id(), chunk_index_half), where, "prepare to create");
  return checked(H5Fcreate(where.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), where, "create");
}

}  // namespace

// ---- attributes

void Object::set_attribute(const std::string& name, std::string_view text) {
  const auto what = "write attribute '" + name + "'";
  // Fixed length, although h5py reads these as bytes: the library crashes at damaged texts of variable length.
  const auto string = owned(H5Tcopy(H5T_C_S1), H5Tclose, where_, what);
  checked(H5Tset_size(string.id(), std::max<std::size_t>(text.size(), 1)), where_, what);
  checked(H5Tset_strpad(string.id(), H5T_STR_NULLPAD), where_, what);
  checked(H5Tset_cset(string.id(), H5T_CSET_UTF8), where_, what);
  const auto scalar = space({}, where_);
  if (has_attribute(name)) checked(H5Adelete(handle_.id(), name.c_str()), where_, what);
  const auto attribute =
      owned(H5Acreate2(handle_.id(), name.c_str(), string.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            where_, what);
  const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
  checked(H5Awrite(attribute.id(), string.id(), padded.data()), where_, what);
}

void Object::set_number(const std::string& name, Number type, const void* value) {
  const auto what = "write attribute '" + name + "'";
  const auto scalar = space({}, where_);
  if (has_attribute(name)) checked(H5Adelete(handle_.id(), name.c_str()), where_, what);
  const auto attribute =
      owned(H5Acreate2(handle_.id(), name.c_str(), native(type), scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            where_, what);
  checked(H5Awrite(attribute.id(), native(type), value), where_, what);
}

bool Object::has_attribute(const std::string& name) const {
  return checked(H5Aexists(handle_.id(), name.c_str()), where_, "look for attribute '" + name + "'") > 0;
}

std::string Object::text(const std::string& name) const {
  const auto what = "read attribute '" + name + "'";
  const auto attribute = owned(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Aclose, where_, what);
  const auto string = owned(H5Aget_type(attribute.id()), H5Tclose, where_, what);
  if (H5Tget_class(string.id()) != H5T_STRING)
    throw FileError(where_ + ": attribute '" + name + "' is not a text; the file is damaged or not of grit");
  if (H5Tis_variable_str(string.id()) != 0)
    throw FileError(where_ + ": attribute '" + name +
                    "' is a text of variable length, as earlier versions of grit wrote; run the description again");
  check_scalar(attribute.id(), where_, name);
  const std::size_t size = H5Tget_size(string.id());
  if (size == 0 || size > length_of_file(handle_.id(), where_))
    throw FileError(where_ + ": attribute '" + name + "' is longer than its file; the file is damaged");
  std::string text(size, '\0');
  checked(H5Aread(attribute.id(), string.id(), text.data()), where_, what);
  text.resize(std::min(text.find('\0'), text.size()));
  if (!is_utf8(text)) throw FileError(where_ + ": attribute '" + name + "' is not UTF-8; the file is damaged");
  return text;
}

std::vector<std::string> Object::words(const std::string& name) const {
  std::istringstream words(has_attribute(name) ? text(name) : "");
  return {std::istream_iterator<std::string>(words), {}};
}

void Object::get_number(const std::string& name, Number type, void* value) const {
  const auto what = "read attribute '" + name + "'";
  const auto attribute = owned(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Aclose, where_, what);
  const auto found = owned(H5Aget_type(attribute.id()), H5Tclose, where_, what);
  if (!is_number_of_grit(found.id()))
    throw FileError(where_ + ": attribute '" + name + "' is not a number; the file is damaged or not of grit");
  check_scalar(attribute.id(), where_, name);
  checked(H5Aread(attribute.id(), native(type), value), where_, what);
}

// ---- datasets

Shape Dataset::shape() const {
  const auto extent = owned(H5Dget_space(handle_.id()), H5Sclose, where_, "read the shape");
  std::vector<hsize_t> dims(
      static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(extent.id()), where_, "read the shape")));
  checked(H5Sget_simple_extent_dims(extent.id(), dims.data(), nullptr), where_, "read the shape");
  return {dims.begin(), dims.end()};
}

std::size_t Dataset::rows() const {
  const auto dims = shape();
  return dims.empty() ? 1 : dims[0];
}

Shape Dataset::readable_shape() const {
  const auto type = owned(H5Dget_type(handle_.id()), H5Tclose, where_, "read the type");
  if (!is_number_of_grit(type.id()))
    throw FileError(where_ + ": does not hold numbers of a type that grit writes; the file is damaged or not of grit");
  Shape dims = shape();
  if (std::ranges::find(dims, std::size_t{0}) != dims.end()) return dims;
  const hsize_t file = length_of_file(handle_.id(), where_);
  hsize_t left = file / H5Tget_size(type.id());
  for (const std::size_t length : dims) left /= length;
  if (left == 0)
    throw FileError(where_ + ": has more numbers than a file of " + std::to_string(file) +
                    " bytes can hold; the file is damaged");
  return dims;
}

Shape Dataset::readable_rows(std::size_t first, std::size_t count) const {
  Shape dims = readable_shape();
  if (dims.empty() || first > dims[0] || count > dims[0] - first)
    throw FileError(where_ + ": has " + std::to_string(dims.empty() ? 1 : dims[0]) + " rows, but rows up to " +
                    std::to_string(first + count) + " are asked for");
  dims[0] = count;
  return dims;
}

void Dataset::get(Number type, void* values) const {
  demand_memory();
  checked(H5Dread(handle_.id(), native(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values), where_, "read");
}

void Dataset::get(Number type, std::size_t first, std::size_t count, void* values) const {
  demand_memory();
  auto dims = shape();
  const auto file = rows_of(handle_.id(), dims, first, count, where_);
  dims[0] = count;
  const auto memory = space(dims, where_);
  checked(H5Dread(handle_.id(), native(type), memory.id(), file.id(), H5P_DEFAULT, values), where_, "read");
}

std::vector<std::byte> Dataset::read_bytes() const {
  std::vector<std::byte> bytes(product(readable_shape()));
  if (!bytes.empty()) get(Number::uint8, bytes.data());
  return bytes;
}

void Dataset::append(Number type, std::size_t size, const void* values) {
  auto dims = shape();
  if (dims.empty()) throw FileError(where_ + ": cannot append: it is a single value");
  const auto row = product(std::span(dims).subspan(1));
  if (row == 0) throw FileError(where_ + ": cannot append: its rows are empty");
  if (size % row != 0)
    throw FileError(where_ + ": cannot append " + std::to_string(size) + " numbers: a row has " + std::to_string(row));
  demand_memory();
  const auto first = dims.at(0), count = size / row;
  dims[0] += count;
  checked(H5Dset_extent(handle_.id(), lengths(dims).data()), where_, "grow");
  const auto file = rows_of(handle_.id(), dims, first, count, where_);
  dims[0] = count;
  const auto memory = space(dims, where_);
  checked(H5Dwrite(handle_.id(), native(type), memory.id(), file.id(), H5P_DEFAULT, values), where_, "write");
}

void Dataset::truncate(std::size_t rows) {
  auto dims = lengths(shape());
  if (dims.empty()) throw FileError(where_ + ": cannot shorten: it is a single value");
  dims[0] = rows;
  checked(H5Dset_extent(handle_.id(), dims.data()), where_, "shorten");
}

// ---- groups

Group Group::create_group(const std::string& name) {
  auto where = child(where_, name);
  auto id = owned(H5Gcreate2(handle_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, where,
                  "create the group");
  return {std::move(id), std::move(where)};
}

Group Group::group(const std::string& name) const {
  auto where = child(where_, name);
  check_link(handle_.id(), name, where);
  auto id = owned(H5Gopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Gclose, where, "open the group");
  return {std::move(id), std::move(where)};
}

Dataset Group::dataset(const std::string& name) const {
  auto where = child(where_, name);
  check_link(handle_.id(), name, where);
  auto id = owned(H5Dopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Dclose, where, "open the dataset");
  check_storage(id.id(), where);
  return {std::move(id), std::move(where)};
}

bool Group::has(const std::string& name) const {
  return checked(H5Lexists(handle_.id(), name.c_str(), H5P_DEFAULT), where_, "look for '" + name + "'") > 0;
}

std::vector<std::string> Group::names() const {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  hsize_t from = 0;
  checked(H5Literate(handle_.id(), H5_INDEX_NAME, H5_ITER_INC, &from, add, &names), where_, "list");
  for (const std::string& name : names)
    if (!is_utf8(name)) throw FileError(where_ + ": holds a name that is not UTF-8; the file is damaged");
  return names;
}

Dataset Group::write(const std::string& name, const Shape& shape, Number type, std::size_t size, const void* values) {
  auto where = child(where_, name);
  if (size != product(shape))
    throw FileError(where + ": cannot write " + std::to_string(size) + " numbers into a shape of " +
                    std::to_string(product(shape)));
  demand_memory();
  const auto extent = space(shape, where);
  const auto creation = owned(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, where, "prepare the dataset");
  // Without a cache, chunks are written now. Otherwise a full disk would be noticed when the dataset is closed, which
  // cannot report errors.
  const auto access = owned(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, where, "prepare the dataset");
  checked(H5Pset_chunk_cache(access.id(), 0, 0, 0), where, "prepare the dataset");
  if (size > 0 && !shape.empty()) {  // checksums are of chunks, which cannot be empty
    auto chunk = lengths(shape);
    const std::size_t row = product(std::span(shape).subspan(1)) * H5Tget_size(native(type));
    chunk[0] = std::clamp<std::size_t>(checked_bytes / row, 1, shape[0]);
    checked(H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()), where, "prepare the dataset");
    checked(H5Pset_fletcher32(creation.id()), where, "prepare the dataset");
  }
  auto id =
      owned(H5Dcreate2(handle_.id(), name.c_str(), native(type), extent.id(), H5P_DEFAULT, creation.id(), access.id()),
            H5Dclose, where, "create the dataset");
  if (size > 0) checked(H5Dwrite(id.id(), native(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values), where, "write");
  return {std::move(id), std::move(where)};
}

Dataset Group::create_growing(const std::string& name, const Shape& row, std::size_t rows_per_chunk, Number type,
                              bool checksums) {
  auto where = child(where_, name);
  std::vector<hsize_t> now{0}, limit{H5S_UNLIMITED}, chunk{rows_per_chunk};
  for (const auto length : row) {
    now.push_back(length);
    limit.push_back(length);
    chunk.push_back(std::max<std::size_t>(length, 1));
  }
  const auto extent = owned(H5Screate_simple(static_cast<int>(now.size()), now.data(), limit.data()), H5Sclose, where,
                            "describe a shape");
  const auto creation = owned(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, where, "prepare the dataset");
  checked(H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()), where, "prepare the dataset");
  const auto access = owned(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, where, "prepare the dataset");
  if (checksums) {
    checked(H5Pset_chunk_cache(access.id(), 0, 0, 0), where, "prepare the dataset");  // as in write()
    checked(H5Pset_fletcher32(creation.id()), where, "prepare the dataset");
  }
  auto id =
      owned(H5Dcreate2(handle_.id(), name.c_str(), native(type), extent.id(), H5P_DEFAULT, creation.id(), access.id()),
            H5Dclose, where, "create the dataset");
  return {std::move(id), std::move(where)};
}

// ---- files

File::File(const std::filesystem::path& path, Mode mode)
    : Group(Handle(open_file(path, mode), H5Fclose), path.string()) {}

void File::flush() {
  demand_memory();
  checked(H5Fflush(handle_.id(), H5F_SCOPE_LOCAL), where_, "write");
}

void File::close() {
  flush();
  checked(H5Fclose(handle_.release()), where_, "close");
}

}  // namespace grit::hdf5
