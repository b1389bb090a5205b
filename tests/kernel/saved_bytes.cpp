// What is saved of structs: their members, and nothing of the memory in the gaps between them, which differs from run
// to run.
#include <gtest/gtest.h>

#include "bodies/clumps.hpp"
#include "domain/deforming_cell.hpp"
#include "grit/archive.hpp"
#include "grit/world.hpp"

namespace grit::test::saved_bytes_tests {
namespace {

template <class T>
std::size_t saved_bytes() {
  T one{};
  return saved_state(one).size();
}

TEST(SavedBytes, AreThoseOfTheMembers) {
  constexpr std::size_t number = sizeof(double), vec3 = 3 * number, mat3 = 9 * number, id = 4;
  EXPECT_EQ(saved_bytes<Clump>(), 3 * id + 6 * vec3 + 4 * number + mat3 + 5 * number);
  EXPECT_EQ(saved_bytes<ClumpSphere>(), id + 3 + vec3);
  EXPECT_EQ(saved_bytes<Departure>(), id + 1 + 2 * number + vec3);
  EXPECT_EQ(saved_bytes<Cell>(), 7 * vec3 + 3);
}

}  // namespace
}  // namespace grit::test::saved_bytes_tests
