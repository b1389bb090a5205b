// Parses SVG pictures.
#pragma once

#include <boost/property_tree/xml_parser.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace grit {

using SvgElement = boost::property_tree::ptree;

inline SvgElement parsed(const std::string& svg) {
  std::istringstream text(svg);
  SvgElement tree;
  read_xml(text, tree);
  return tree;
}

/// Elements of a name, and with the given word in their class unless it is empty.
inline std::vector<SvgElement> elements(const SvgElement& tree, const std::string& name, const std::string& word = {}) {
  std::vector<SvgElement> found;
  for (const auto& [tag, child] : tree) {
    const auto classes = ' ' + child.get<std::string>("<xmlattr>.class", "") + ' ';
    if (tag == name && (word.empty() || classes.find(' ' + word + ' ') != std::string::npos)) found.push_back(child);
    for (auto& deeper : elements(child, name, word)) found.push_back(std::move(deeper));
  }
  return found;
}

inline double number_of(const SvgElement& element, const std::string& attribute) {
  return element.get<double>("<xmlattr>." + attribute);
}
inline std::string text_of(const SvgElement& element, const std::string& attribute) {
  return element.get<std::string>("<xmlattr>." + attribute, "");
}

/// The texts, in order.
inline std::vector<std::string> words_of(const SvgElement& tree, const std::string& word = {}) {
  std::vector<std::string> words;
  for (const auto& text : elements(tree, "text", word)) words.push_back(text.data());
  return words;
}

}  // namespace grit
