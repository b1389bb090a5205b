#include "output/page.hpp"

#include "output/own_files.hpp"
#include "output/svg.hpp"

namespace grit {

extern const std::string_view page_style;  // page.css

std::string page_begin(std::string_view title, std::string_view style, std::string_view head) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += page_mark;
  html += '\n';
  html += head;
  html += "<title>" + escaped(title) + "</title>\n<style>\n";
  html += page_style;
  html += style;
  html += "</style></head>\n<body>\n";
  return html;
}

}  // namespace grit
