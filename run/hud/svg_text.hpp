// SPDX-License-Identifier: MIT
#pragma once
// SVG documents as text: what is refused before anything draws them, and their bindings, {{name}}, filled with values.
// It reads tags and attributes; whether they are well-formed XML, librsvg says.

#include <cstdint>
#include <darkroom/hud_document.hpp>
#include <darkroom/result.hpp>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace darkroom {

using HudValues = std::map<std::string, HudValue, std::less<>>;

/// Of an element, by its id, and a class of it: whether it has it.
using HudClasses = std::map<std::pair<std::string, std::string>, bool>;

/// What check_svg() finds on its way. Places are of the text that was checked.
struct SvgFacts {
    struct Element {
        std::string id;
        std::size_t at = 0;                           ///< behind its name
        std::size_t class_begin = 0, class_size = 0;  ///< the value; no begin: it has none
    };
    std::vector<Element> elements;     ///< those with an id
    std::vector<std::string> scripts;  ///< what <script> elements name by `src` or `href`, in order, each once
    std::size_t root_at = 0;           ///< behind the name of the outermost element
    double reference_height = 0;       ///< its data-reference-height; 0: none
    bool has_view_box = false;
};

/// A document that stands by itself: tags that close each other, no document type (and so no entities), no processing
/// instructions, UTF-8, and no reference but to its own elements (#name), as it reads once XML's entities and CSS's
/// escapes are undone. The error is "line: reason".
[[nodiscard]] Result<> check_svg(std::string_view document, std::uint32_t max_elements, SvgFacts* facts = nullptr);

/// How many pixels of a picture a unit of the document is: `height` over its reference height, or `scale` where it has
/// neither one nor a viewBox.
[[nodiscard]] std::string at_size(std::string document, const SvgFacts& facts, std::uint32_t width,
                                  std::uint32_t height, double scale);
/// With classes added to elements, or taken from them.
[[nodiscard]] std::string with_classes(std::string document, const SvgFacts& facts, const HudClasses& classes);

/// A document cut at its bindings, {{name}} or {{name:00.0}}, which may stand wherever text may: between tags and in
/// attributes' values. Zeros before the point are the fewest digits of a number, those behind it its decimals.
class SvgTemplate {
  public:
    /// Names are words of letters, digits, '_', '-' and '.'. The error is "line: reason".
    [[nodiscard]] static Result<SvgTemplate> parse(std::string document);
    /// The document with the values in place, escaped, so that they are text and never tags. A name without a value is
    /// an error, "line: reason".
    [[nodiscard]] Result<std::string> fill(const HudValues& values) const;
    /// Does a text change where this name has another value?
    [[nodiscard]] bool shows(std::string_view name, const HudValue* before, const HudValue& after) const;

  private:
    struct Binding {
        std::size_t begin = 0, end = 0;  ///< with its braces
        std::string name;
        /// Of numbers; no decimals and no digits: the shortest form.
        int digits = 0, decimals = 0;
    };
    static std::string text_of(const Binding& binding, const HudValue& value);
    std::string document_;
    std::vector<Binding> bindings_;
};

}  // namespace darkroom
