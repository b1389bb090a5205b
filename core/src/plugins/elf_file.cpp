#include "plugins/elf_file.hpp"

#include <link.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <vector>

#include "plugins/loader.hpp"

namespace grit {
namespace {

using Header = ElfW(Ehdr);
using Segment = ElfW(Phdr);

/// Numbers of type T at `offset`; none if the file ends before.
template <class T>
bool read_at(std::ifstream& file, std::uint64_t offset, T* numbers, std::size_t count) {
  file.seekg(static_cast<std::streamoff>(offset));
  return bool(file.read(reinterpret_cast<char*>(numbers), static_cast<std::streamsize>(count * sizeof(T))));
}

/// The header of an ELF file; none of another file.
std::optional<Header> header_of(std::ifstream& file) {
  Header elf;
  if (!read_at(file, 0, &elf, 1) || std::memcmp(elf.e_ident, ELFMAG, SELFMAG) != 0) return std::nullopt;
  return elf;
}

bool same_machine(const Header& a, const Header& b) {
  return a.e_ident[EI_CLASS] == b.e_ident[EI_CLASS] && a.e_ident[EI_DATA] == b.e_ident[EI_DATA] &&
         a.e_machine == b.e_machine;
}

}  // namespace

std::string elf_fault(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary), own_file(library_file(), std::ios::binary);
  const auto elf = header_of(file), own = header_of(own_file);
  if (!elf) return {};
  if (own && !same_machine(*elf, *own))
    return "is of another machine: expected ELF class " + std::to_string(own->e_ident[EI_CLASS]) + ", machine " +
           std::to_string(own->e_machine) + ", found class " + std::to_string(elf->e_ident[EI_CLASS]) +
           ", machine " + std::to_string(elf->e_machine);

  file.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(file.tellg());
  const auto fits = [size](std::uint64_t offset, std::uint64_t bytes) {
    return offset <= size && bytes <= size - offset;
  };
  const std::string incomplete = "is incomplete: it has " + std::to_string(size) + " bytes, ";
  if (elf->e_phentsize != sizeof(Segment)) return "has program headers of another size";
  std::vector<Segment> segments(elf->e_phnum);
  if (!read_at(file, elf->e_phoff, segments.data(), segments.size()))
    return incomplete + "and ends before its program headers";
  for (const Segment& segment : segments)
    if (!fits(segment.p_offset, segment.p_filesz))
      return incomplete + "and its segments end at " + std::to_string(segment.p_offset + segment.p_filesz);
  if (!fits(elf->e_shoff, std::uint64_t{elf->e_shnum} * elf->e_shentsize))
    return incomplete + "and its section headers end at " +
           std::to_string(elf->e_shoff + std::uint64_t{elf->e_shnum} * elf->e_shentsize);
  return {};
}

}  // namespace grit
