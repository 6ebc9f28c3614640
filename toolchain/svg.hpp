// A picture of a run, drawn by a machine's host program as SVG: lines, circles and characters only, so that
// any browser shows it.
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

namespace tappet {

/// White background; units are px.
class Svg {
public:
    Svg(double width, double height) {
        raw("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"");
        at("width", width).at("height", height);
        raw(" font-family=\"sans-serif\" font-size=\"13\">\n");
        rectangle(0, 0, width, height, "fill=\"#fff\"");
    }
    Svg& raw(std::string_view characters) {
        text_ += characters;
        return *this;
    }
    Svg& number(double value) {
        std::array<char, 32> digits{};
        const auto end =
            std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, 2);
        text_.append(digits.data(), end.ptr);
        return *this;
    }
    Svg& at(std::string_view attribute, double value) {
        return raw(" ").raw(attribute).raw("=\"").number(value).raw("\"");
    }
    Svg& rectangle(double x, double y, double w, double h, std::string_view style) {
        raw("<rect").at("x", x).at("y", y).at("width", w).at("height", h);
        return raw(" ").raw(style).raw("/>\n");
    }
    Svg& line(double x1, double y1, double x2, double y2, std::string_view style) {
        raw("<line").at("x1", x1).at("y1", y1).at("x2", x2).at("y2", y2);
        return raw(" ").raw(style).raw("/>\n");
    }
    Svg& circle(double x, double y, double radius, std::string_view style) {
        raw("<circle").at("cx", x).at("cy", y).at("r", radius);
        return raw(" ").raw(style).raw("/>\n");
    }
    Svg& words(double x, double y, std::string_view characters, std::string_view style = {}) {
        raw("<text").at("x", x).at("y", y);
        return raw(" ").raw(style).raw(">").raw(characters).raw("</text>\n");
    }
    /// Returns the whole document and leaves this object empty.
    [[nodiscard]] std::string take() {
        raw("</svg>\n");
        return std::move(text_);
    }

private:
    std::string text_;
};

} // namespace tappet
