// What may follow on a command line, for the scripts of completion/ that shells load.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace grit {

/// Prints a line for each word that may stand in the place of the last one, which is begun or empty: the word, a tab
/// and what it means. A line may instead ask the shell for names of files, `:files *.json`, of folders, `:folders`, or
/// of folders that hold runs, `:results`. For a value the name of which says what it is:
///   FILE, STUDY     a JSON file            DIR        a folder
///   PAGE            an HTML file           RESULTS    a folder of results
///   HOSTS           any file               COMMAND    a command
///   PLUGIN          a component            NAME       a component, or a section of descriptions
///   KIND            a kind of plugin
///   one|other       these words
/// Others, such as numbers, have no candidates.
void print_candidates(const std::vector<std::string>& words, std::ostream& out);

}  // namespace grit
