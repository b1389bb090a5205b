#include "storage/hdf5.hpp"

#include <hdf5.h>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "grit/error.hpp"

namespace grit::hdf5 {
namespace {

static_assert(std::same_as<hid_t, std::int64_t> && std::same_as<herr_t, int>);

// 2 · 128 chunks fit one node of the index: for half a million samples it is not split, and so never partly rewritten.
constexpr unsigned chunk_index_half = 128;
// Growth increment of a copy in memory.
constexpr std::size_t copy_increment = std::size_t{1} << 16;
// Block size of a checksum.
constexpr std::size_t checked_bytes = std::size_t{1} << 20;

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

hid_t open_file(const std::filesystem::path& path, Mode mode) {
  // A file that could not be closed because of a full disk would be closed again at exit, which crashes. All other
  // files are closed by then. Must be called before any other function of the library.
  static const herr_t no_cleanup = H5dont_atexit();
  static_cast<void>(no_cleanup);
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
  cache.evictions_enabled = mode == Mode::read || mode == Mode::copy;
  if (!cache.evictions_enabled) {
    cache.incr_mode = H5C_incr__off;
    cache.flash_incr_mode = H5C_flash_incr__off;
    cache.decr_mode = H5C_decr__off;
  }
  checked(H5Pset_mdc_config(access.id(), &cache), where, "prepare to open");
  if (mode == Mode::copy) checked(H5Pset_fapl_core(access.id(), copy_increment, false), where, "prepare to open");
  switch (mode) {
    case Mode::read:
    case Mode::copy:
      return checked(H5Fopen(where.c_str(), H5F_ACC_RDONLY, access.id()), where, "read");
    case Mode::change: {
      Handle file = owned(H5Fopen(where.c_str(), H5F_ACC_RDWR, access.id()), H5Fclose, where, "change");
      // A flush writes the file length last: a writer killed during a flush may have left it too short.
      checked(H5Fincrement_filesize(file.id(), 0), where, "change");
      return file.release();
    }
    case Mode::replace:
      break;
  }
  const auto creation = owned(H5Pcreate(H5P_FILE_CREATE), H5Pclose, where, "prepare to create");
  checked(H5Pset_istore_k(creation.id(), chunk_index_half), where, "prepare to create");
  return checked(H5Fcreate(where.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), where, "create");
}

}  // namespace

// ---- attributes

void Object::set_attribute(const std::string& name, std::string_view text) {
  const auto what = "write attribute '" + name + "'";
  // Variable length: h5py reads these as str, and fixed-length ones as bytes.
  const auto string = owned(H5Tcopy(H5T_C_S1), H5Tclose, where_, what);
  checked(H5Tset_size(string.id(), H5T_VARIABLE), where_, what);
  checked(H5Tset_cset(string.id(), H5T_CSET_UTF8), where_, what);
  const auto scalar = space({}, where_);
  if (has_attribute(name)) checked(H5Adelete(handle_.id(), name.c_str()), where_, what);
  const auto attribute =
      owned(H5Acreate2(handle_.id(), name.c_str(), string.id(), scalar.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            where_, what);
  const std::string terminated(text);
  const char* value = terminated.c_str();
  checked(H5Awrite(attribute.id(), string.id(), &value), where_, what);
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
  if (H5Tis_variable_str(string.id()) <= 0)
    throw FileError(where_ + ": attribute '" + name + "' is not a variable-length text");
  char* value = nullptr;
  checked(H5Aread(attribute.id(), string.id(), &value), where_, what);
  std::string text(value == nullptr ? "" : value);
  H5free_memory(value);
  return text;
}

std::vector<std::string> Object::words(const std::string& name) const {
  std::istringstream words(has_attribute(name) ? text(name) : "");
  return {std::istream_iterator<std::string>(words), {}};
}

void Object::get_number(const std::string& name, Number type, void* value) const {
  const auto what = "read attribute '" + name + "'";
  const auto attribute = owned(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Aclose, where_, what);
  checked(H5Aread(attribute.id(), native(type), value), where_, what);
}

// ---- datasets

Shape Dataset::shape() const {
  const auto extent = owned(H5Dget_space(handle_.id()), H5Sclose, where_, "read the shape");
  std::vector<hsize_t> dims(checked(H5Sget_simple_extent_ndims(extent.id()), where_, "read the shape"));
  checked(H5Sget_simple_extent_dims(extent.id(), dims.data(), nullptr), where_, "read the shape");
  return {dims.begin(), dims.end()};
}

std::size_t Dataset::rows() const {
  const auto dims = shape();
  return dims.empty() ? 1 : dims[0];
}

void Dataset::get(Number type, void* values) const {
  checked(H5Dread(handle_.id(), native(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values), where_, "read");
}

void Dataset::get(Number type, std::size_t first, std::size_t count, void* values) const {
  auto dims = shape();
  const auto file = rows_of(handle_.id(), dims, first, count, where_);
  dims[0] = count;
  const auto memory = space(dims, where_);
  checked(H5Dread(handle_.id(), native(type), memory.id(), file.id(), H5P_DEFAULT, values), where_, "read");
}

std::vector<std::byte> Dataset::read_bytes() const {
  std::vector<std::byte> bytes(product(shape()));
  if (!bytes.empty()) get(Number::uint8, bytes.data());
  return bytes;
}

void Dataset::append(Number type, std::size_t size, const void* values) {
  auto dims = shape();
  const auto row = product(std::span(dims).subspan(1));
  if (row == 0) throw FileError(where_ + ": cannot append: its rows are empty");
  if (size % row != 0)
    throw FileError(where_ + ": cannot append " + std::to_string(size) + " numbers: a row has " + std::to_string(row));
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
  dims.at(0) = rows;
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
  auto id = owned(H5Gopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Gclose, where, "open the group");
  return {std::move(id), std::move(where)};
}

Dataset Group::dataset(const std::string& name) const {
  auto where = child(where_, name);
  auto id = owned(H5Dopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Dclose, where, "open the dataset");
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
  return names;
}

Dataset Group::write(const std::string& name, const Shape& shape, Number type, std::size_t size, const void* values) {
  auto where = child(where_, name);
  const auto extent = space(shape, where);
  auto id =
      owned(H5Dcreate2(handle_.id(), name.c_str(), native(type), extent.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose, where, "create the dataset");
  if (size != product(shape))
    throw FileError(where + ": cannot write " + std::to_string(size) + " numbers into a shape of " +
                    std::to_string(product(shape)));
  if (size > 0) checked(H5Dwrite(id.id(), native(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, values), where, "write");
  return {std::move(id), std::move(where)};
}

Dataset Group::write_checked(const std::string& name, std::span<const std::byte> bytes) {
  auto where = child(where_, name);
  const Shape shape{bytes.size()};
  if (bytes.empty()) return write(name, shape, Number::uint8, 0, nullptr);  // a chunk cannot be empty
  const auto extent = space(shape, where);
  const auto creation = owned(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, where, "prepare the dataset");
  const hsize_t chunk = std::min(bytes.size(), checked_bytes);
  checked(H5Pset_chunk(creation.id(), 1, &chunk), where, "prepare the dataset");
  checked(H5Pset_fletcher32(creation.id()), where, "prepare the dataset");
  auto id = owned(H5Dcreate2(handle_.id(), name.c_str(), native(Number::uint8), extent.id(), H5P_DEFAULT, creation.id(),
                             H5P_DEFAULT),
                  H5Dclose, where, "create the dataset");
  checked(H5Dwrite(id.id(), native(Number::uint8), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), where, "write");
  return {std::move(id), std::move(where)};
}

Dataset Group::create_growing(const std::string& name, const Shape& row, std::size_t rows_per_chunk, Number type) {
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
  auto id =
      owned(H5Dcreate2(handle_.id(), name.c_str(), native(type), extent.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
            H5Dclose, where, "create the dataset");
  return {std::move(id), std::move(where)};
}

// ---- files

File::File(const std::filesystem::path& path, Mode mode)
    : Group(Handle(open_file(path, mode), H5Fclose), path.string()) {}

void File::flush() { checked(H5Fflush(handle_.id(), H5F_SCOPE_LOCAL), where_, "write"); }

void File::close() {
  flush();
  checked(H5Fclose(handle_.release()), where_, "close");
}

}  // namespace grit::hdf5
