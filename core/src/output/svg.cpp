#include "output/svg.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "format/utf8.hpp"
#include "grit/toolkit/text_file.hpp"
#include "output/own_files.hpp"

namespace grit {
namespace {

void put(std::string& out, double value) {
  char digits[32];
  const double rounded = std::round(value * 100) / 100 + 0.0;  // + 0.0 makes −0 a 0
  out.append(digits, std::to_chars(digits, digits + sizeof digits, rounded).ptr);
}

}  // namespace

std::string escaped(std::string_view text) {
  const auto is_control = [](char c) { return c >= 0 && c < ' ' && c != '\n' && c != '\t' && c != '\r'; };
  if (!is_utf8(text) || std::ranges::any_of(text, is_control)) return escaped(visible_text(text));
  std::string all;
  for (const char c : text) switch (c) {
      case '&':
        all += "&amp;";
        break;
      case '<':
        all += "&lt;";
        break;
      case '>':
        all += "&gt;";
        break;
      case '"':
        all += "&quot;";
        break;
      default:
        all += c;
    }
  return all;
}

Svg::Svg(double width, double height, std::string_view title, std::string_view style) {
  out_ += R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 )";
  put(out_, width);
  out_ += ' ';
  put(out_, height);
  out_ += '"';
  attribute("width", width);
  attribute("height", height);
  out_ += ">\n";
  out_ += picture_mark;
  out_ += "\n<title>";
  out_ += escaped(title);
  out_ += "</title>\n<style>\n";
  out_ += style;
  out_ += "</style>\n";
}

void Svg::open_group(std::string_view attributes) {
  element("g", attributes);
  out_ += ">\n";
}

void Svg::close_group() { out_ += "</g>\n"; }

void Svg::clip(std::string_view id, Point corner, double width, double height) {
  out_ += "<clipPath id=\"";
  out_ += escaped(id);
  out_ += "\">\n";
  rectangle(corner, width, height);
  out_ += "</clipPath>\n";
}

void Svg::line(Point from, Point to, std::string_view attributes) {
  element("line", attributes);
  attribute("x1", from.x);
  attribute("y1", from.y);
  attribute("x2", to.x);
  attribute("y2", to.y);
  out_ += "/>\n";
}

void Svg::polyline(std::span<const Point> points, std::string_view attributes) {
  element("polyline", attributes);
  out_ += " points=\"";
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) out_ += ' ';
    put(out_, points[i].x);
    out_ += ',';
    put(out_, points[i].y);
  }
  out_ += "\"/>\n";
}

void Svg::circle(Point centre, double radius, std::string_view attributes) {
  element("circle", attributes);
  attribute("cx", centre.x);
  attribute("cy", centre.y);
  attribute("r", radius);
  out_ += "/>\n";
}

void Svg::rectangle(Point corner, double width, double height, std::string_view attributes) {
  element("rect", attributes);
  attribute("x", corner.x);
  attribute("y", corner.y);
  attribute("width", width);
  attribute("height", height);
  out_ += "/>\n";
}

void Svg::text(Point at, std::string_view text, std::string_view attributes) {
  element("text", attributes);
  attribute("x", at.x);
  attribute("y", at.y);
  out_ += '>';
  out_ += escaped(text);
  out_ += "</text>\n";
}

std::string Svg::finish() && {
  out_ += "</svg>\n";
  return std::move(out_);
}

void Svg::element(std::string_view name, std::string_view attributes) {
  out_ += '<';
  out_ += name;
  if (!attributes.empty()) {
    out_ += ' ';
    out_ += attributes;
  }
}

void Svg::attribute(std::string_view name, double value) {
  out_ += ' ';
  out_ += name;
  out_ += "=\"";
  put(out_, value);
  out_ += '"';
}

}  // namespace grit
