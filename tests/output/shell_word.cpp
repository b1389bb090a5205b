#include "output/shell_word.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/program.hpp"

namespace grit::shell_word_tests {
namespace {

TEST(ShellWord, IsPlainIfPossible) {
  for (const char* word : {"results/quick-rn-0.25", "../a_b/C:1,2", "größe"}) EXPECT_EQ(shell_word(word), word);
}

TEST(ShellWord, IsQuotedIfNecessary) {
  EXPECT_EQ(shell_word("my results/two"), "\"my results/two\"");
  EXPECT_EQ(shell_word("it's"), "\"it's\"");
  EXPECT_EQ(shell_word(R"(/a={"type": "b"})"), R"('/a={"type": "b"}')");
  EXPECT_EQ(shell_word("no!"), "'no!'");
  EXPECT_EQ(shell_word("it's $5"), R"('it'\''s $5')");
  EXPECT_EQ(shell_word(""), "\"\"");
}

TEST(ShellWord, IsReadBackByAShell) {
  for (const std::string word :
       {"my results", "it's", "$HOME `ls` \\n \"x\"", "it's $HOME!", "a;b&c|d>e<f*g?(h)[i]{j}~k#l", "größe"})
    EXPECT_EQ(shell(".", "printf %s " + shell_word(word)).out, word);
}

}  // namespace
}  // namespace grit::shell_word_tests
