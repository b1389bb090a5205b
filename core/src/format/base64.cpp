#include "format/base64.hpp"

#include <algorithm>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstddef>

namespace grit {

std::string base64(std::vector<unsigned char> bytes) {
  const std::size_t size = bytes.size();
  bytes.resize((size + 2) / 3 * 3);  // the iterators take three bytes at a time
  using namespace boost::archive::iterators;
  using Text = base64_from_binary<transform_width<const unsigned char*, 6, 8>>;
  std::string text(Text(bytes.data()), Text(bytes.data() + bytes.size()));
  std::fill_n(text.rbegin(), bytes.size() - size, '=');
  return text;
}

}  // namespace grit
