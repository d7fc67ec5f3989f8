// SPDX-License-Identifier: MIT
#include "hud/svg_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/text/lower.hpp"
#include "core/text/markup.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {

namespace {

/// librsvg and what it is made of go into each by a call.
constexpr std::size_t max_depth = 200;
constexpr std::size_t max_scripts = 16;
constexpr double max_reference_height = 65536;
constexpr std::size_t max_zeros = 15;  // of a number's form: what a double holds
constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view style_blanks = " \t\r\n\f";

std::size_t line_of(std::string_view text, std::size_t at) {
    return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, at), '\n'));
}

std::string_view without_prefix(std::string_view name) {
    const std::size_t colon = name.rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// A character as CSS compares it; of those beyond ASCII none matters here.
char narrow(std::uint32_t code) { return code < 128 ? static_cast<char>(code) : '?'; }

/// What an XML parser makes of the text of an element or an attribute: the five entities that every document has, and
/// characters by number. All else stays, as no document has entities of its own.
std::string without_entities(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, char>, 5> known{
        {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}}};
    std::string out;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const std::size_t end = text[at] == '&' ? text.find(';', at) : std::string_view::npos;
        if (end == std::string_view::npos) {
            out += text[at];
            continue;
        }
        const std::string_view name = text.substr(at + 1, end - at - 1);
        const auto* const entity = std::ranges::find(known, name, &std::pair<std::string_view, char>::first);
        const bool is_hexadecimal = name.starts_with("#x");
        const std::string_view digits = name.substr(std::min<std::size_t>(is_hexadecimal ? 2 : 1, name.size()));
        std::uint32_t code = 0;
        const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), code, is_hexadecimal ? 16 : 10);
        if (entity != known.end()) {
            out += entity->second;
        } else if (name.starts_with('#') && read.ec == std::errc() && read.ptr == digits.data() + digits.size()) {
            out += narrow(code);
        } else {
            out += '&';
            continue;
        }
        at = end;
    }
    return out;
}

/// CSS Syntax Level 3, 4.3.7: a backslash and up to six hexadecimal digits with one blank behind them, or any other
/// character as itself. What is neither a letter nor a mark of a reference becomes '?', so that no escaped quote or '#'
/// makes a target look like the document's own.
std::string without_escapes(std::string_view text) {
    std::string out;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text[at] != '\\') {
            out += text[at];
            continue;
        }
        const std::size_t most = std::min(text.size(), at + 7);
        std::size_t end = at + 1;
        std::uint32_t code = 0;
        for (; end < most && std::isxdigit(static_cast<unsigned char>(text[end])) != 0; ++end)
            code = code * 16 + static_cast<std::uint32_t>(std::stoi(std::string(1, text[end]), nullptr, 16));
        if (end == at + 1) {
            if (end < text.size()) code = static_cast<unsigned char>(text[end++]);
        } else if (text.substr(end).starts_with("\r\n")) {
            end += 2;
        } else if (end < text.size() && style_blanks.find(text[end]) != std::string_view::npos) {
            ++end;
        }
        const char plain = narrow(code);
        out += std::isalpha(static_cast<unsigned char>(plain)) != 0 || plain == '@' || plain == '(' ? plain : '?';
        at = end - 1;
    }
    return out;
}

/// Reads a document from its beginning to its end, and stops at the first thing that is refused.
class Checker {
  public:
    Checker(std::string_view text, std::uint32_t max_elements) : text_(text), max_elements_(max_elements) {}
    [[nodiscard]] SvgFacts take_facts() { return std::move(facts_); }

    Result<> run() {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
        start_ = at_;
        if (text_.find('\0') != std::string_view::npos) return refuse("a zero byte: allowed is text in UTF-8");
        while (error_.empty() && at_ < text_.size()) {
            const std::size_t tag = std::min(text_.find('<', at_), text_.size());
            if (is_in_style_) style_ += without_entities(text_.substr(at_, tag - at_));
            at_ = tag;
            if (error_.empty() && at_ < text_.size()) read_markup();
        }
        if (error_.empty() && !open_.empty()) {
            at_ = open_.back().at;
            refuse(fmt::format("<{}> is not closed", printable(open_.back().name)));
        }
        return error_.empty() ? Result<>{} : Result<>(user_error(error_));
    }

  private:
    [[nodiscard]] std::string_view rest() const { return text_.substr(at_); }

    Result<> refuse(std::string_view reason) {
        if (error_.empty()) error_ = fmt::format("{}: {}", line_of(text_, at_), reason);
        return user_error(error_);
    }

    /// To behind `end`.
    void skip_past(std::string_view end) {
        const std::size_t found = text_.find(end, at_);
        if (found == std::string_view::npos)
            refuse(fmt::format("the end '{}' is missing", end));
        else
            at_ = found + end.size();
    }

    void read_markup() {
        if (rest().starts_with("<!--")) return skip_past("-->");
        if (rest().starts_with("<![CDATA[")) {
            const std::size_t begin = at_;
            skip_past("]]>");
            constexpr std::size_t mark = std::string_view("<![CDATA[").size(), end_mark = 3;
            if (is_in_style_ && error_.empty()) style_ += text_.substr(begin + mark, at_ - begin - mark - end_mark);
            return;
        }
        if (rest().starts_with("<!")) {
            refuse("a document type or an entity: neither is allowed");
        } else if (rest().starts_with("<?")) {
            read_declaration();
        } else if (rest().starts_with("</")) {
            read_end();
        } else {
            read_tag();
        }
    }

    void read_declaration() {
        if (at_ != start_ || !rest().starts_with("<?xml ")) {
            refuse("a processing instruction: allowed is '<?xml ...?>' at the beginning");
            return;
        }
        const std::size_t begin = at_;
        skip_past("?>");
        const std::string declaration = lower(text_.substr(begin, at_ - begin));
        if (declaration.find("encoding") != std::string::npos && declaration.find("utf-8") == std::string::npos)
            refuse("an encoding other than UTF-8");
    }

    void read_end() {
        // As a whole: comments and CDATA may cut its words in pieces.
        if (is_in_style_) check_style(style_);
        is_in_style_ = false;
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n>", at_), text_.size());
        const std::string_view name = text_.substr(at_ + 2, end - at_ - 2);
        if (open_.empty() || open_.back().name != name) {
            refuse(open_.empty() ? fmt::format("</{}> closes nothing", printable(name))
                                 : fmt::format("</{}> where <{}> of line {} is open", printable(name),
                                               printable(open_.back().name), line_of(text_, open_.back().at)));
            return;
        }
        open_.pop_back();
        skip_past(">");
    }

    std::string_view read_name() {
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n=/><\"'", at_), text_.size());
        const std::string_view name = text_.substr(at_, end - at_);
        at_ = end;
        return name;
    }

    void read_tag() {
        if (++elements_ > max_elements_) {
            refuse(fmt::format("more than {} elements", max_elements_));
            return;
        }
        const std::size_t begin = at_++;
        const std::string_view full_name = read_name(), element = without_prefix(full_name);
        if (is_in_style_) {
            refuse(fmt::format("<{}> in <style>, which holds text alone", printable(element)));
            return;
        }
        if (element == "image" || element == "feImage" || element == "include") {
            refuse(fmt::format("<{}> takes in other files: a document stands by itself", element));
            return;
        }
        if (elements_ == 1) facts_.root_at = at_;
        element_ = {.at = at_};
        while (error_.empty()) {
            at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
            if (rest().starts_with(">") || rest().starts_with("/>")) {
                is_in_style_ = element == "style" && rest().front() == '>';
                style_.clear();
                if (rest().front() == '>') open_.push_back({full_name, begin});
                if (open_.size() > max_depth) refuse(fmt::format("elements in more than {} others", max_depth));
                if (!element_.id.empty()) facts_.elements.push_back(std::move(element_));
                if (elements_ == 1 && facts_.reference_height > 0 && facts_.has_view_box)
                    refuse("data-reference-height beside viewBox: one of them says how large a unit is");
                at_ += rest().front() == '>' ? 1 : 2;
                return;
            }
            read_attribute(element);
        }
    }

    void read_attribute(std::string_view element) {
        const std::size_t begin = at_;
        const std::string_view name = read_name();
        at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
        const bool has_value = rest().starts_with("=");
        at_ = std::min(text_.find_first_not_of(blanks, at_ + (has_value ? 1 : 0)), text_.size());
        const std::string_view quote = rest().substr(0, 1);
        const std::size_t end = quote == "\"" || quote == "'" ? text_.find(quote, at_ + 1) : std::string_view::npos;
        if (name.empty() || !has_value || end == std::string_view::npos) {
            at_ = begin;
            refuse(fmt::format("<{}>: allowed are attributes as name=\"value\"", printable(element)));
            return;
        }
        const std::string_view value = text_.substr(at_ + 1, end - at_ - 1);
        const std::string_view kind = without_prefix(name);
        const bool is_reference = kind == "href" || kind == "src" || (kind == "base" && kind != name);
        if (kind != "base" && is_reference && element == "script" && !value.empty())
            add_script(without_entities(value));
        // What a link or a script names is nothing that is drawn.
        if (is_reference && element != "a" && element != "script" && !value.starts_with('#'))
            refuse(fmt::format("{}=\"{}\": allowed is #name, of an element of the document", printable(name),
                               printable(value)));
        check_style(without_entities(value));
        note(name, value);
        at_ = end + 1;
    }

    void note(std::string_view name, std::string_view value) {
        if (name == "id") element_.id = without_entities(value);
        if (name == "class") {
            element_.class_begin = static_cast<std::size_t>(value.data() - text_.data());
            element_.class_size = value.size();
        }
        if (elements_ != 1) return;
        facts_.has_view_box |= name == "viewBox";
        if (name != "data-reference-height") return;
        const auto read = std::from_chars(value.data(), value.data() + value.size(), facts_.reference_height);
        const bool is_number = read.ec == std::errc() && read.ptr == value.data() + value.size();
        if (!is_number || !(facts_.reference_height >= 1 && facts_.reference_height <= max_reference_height))
            refuse(fmt::format("data-reference-height=\"{}\": allowed is a number in [1, {}]", printable(value),
                               max_reference_height));
    }

    void add_script(std::string name) {
        if (std::ranges::count(facts_.scripts, name) > 0) return;
        if (facts_.scripts.size() == max_scripts) refuse(fmt::format("more than {} scripts", max_scripts));
        facts_.scripts.push_back(std::move(name));
    }

    /// References as CSS and presentation attributes have them, in what the parser of XML makes of a text.
    void check_style(std::string_view text) {
        if (text.find_first_of("(@\\") == std::string_view::npos) return;
        const std::string words = lower(without_escapes(text));
        if (words.find("@import") != std::string::npos) refuse("@import: a document stands by itself");
        for (std::size_t i = words.find("url("); i != std::string::npos; i = words.find("url(", i + 1)) {
            const auto first_after = [&](std::size_t at) {
                return std::min(words.find_first_not_of(style_blanks, at), words.size());
            };
            std::size_t target = first_after(i + 4);
            if (target < words.size() && (words[target] == '"' || words[target] == '\''))
                target = first_after(target + 1);
            if (target == words.size() || words[target] != '#')
                refuse(fmt::format("{}: allowed is url(#name), of an element of the document",
                                   printable(words.substr(i, 60))));
        }
    }

    struct Open {
        std::string_view name;
        std::size_t at = 0;
    };

    std::string_view text_;
    std::vector<Open> open_;
    std::uint32_t max_elements_;
    SvgFacts facts_;
    SvgFacts::Element element_;  // that is being read
    std::size_t at_ = 0, start_ = 0;
    std::uint32_t elements_ = 0;
    bool is_in_style_ = false;
    std::string style_;  // the text of the <style> that is being read
    std::string error_;
};

/// Of "00.0".
bool read_form(std::string_view text, int& digits, int& decimals) {
    const std::size_t point = std::min(text.find('.'), text.size());
    const std::string_view whole = text.substr(0, point), part = text.substr(std::min(point + 1, text.size()));
    digits = static_cast<int>(whole.size());
    decimals = static_cast<int>(part.size());
    return !whole.empty() && whole.size() <= max_zeros && part.size() <= max_zeros &&
           part.empty() == (point == text.size()) && whole.find_first_not_of('0') == std::string_view::npos &&
           part.find_first_not_of('0') == std::string_view::npos;
}

bool is_name(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
    });
}

}  // namespace

Result<> check_svg(std::string_view document, std::uint32_t max_elements, SvgFacts* facts) {
    Checker checker(document, max_elements);
    Result<> done = checker.run();
    if (done && facts != nullptr) *facts = checker.take_facts();
    return done;
}

std::string at_size(std::string document, const SvgFacts& facts, std::uint32_t width, std::uint32_t height,
                    double scale) {
    const double unit = facts.reference_height > 0 ? height / facts.reference_height : scale;
    if (facts.has_view_box || unit == 1) return document;
    return document.insert(facts.root_at, fmt::format(" viewBox=\"0 0 {} {}\"", width / unit, height / unit));
}

std::string with_classes(std::string document, const SvgFacts& facts, const HudClasses& classes) {
    // From the last, so that the places of the others stay.
    for (auto element = facts.elements.rbegin(); element != facts.elements.rend(); ++element) {
        std::string words = fmt::format(" {} ", document.substr(element->class_begin, element->class_size));
        std::ranges::replace_if(
            words, [](char c) { return blanks.find(c) != std::string_view::npos; }, ' ');
        bool is_changed = false;
        for (auto of = classes.lower_bound({element->id, ""}); of != classes.end() && of->first.first == element->id;
             ++of) {
            const std::string word = fmt::format(" {} ", of->first.second);
            for (std::size_t at = words.find(word); at != std::string::npos; at = words.find(word))
                words.erase(at, word.size() - 1);
            if (of->second) words += word.substr(1);
            is_changed = true;
        }
        if (!is_changed) continue;
        if (element->class_begin > 0)
            document.replace(element->class_begin, element->class_size, words);
        else
            document.insert(element->at, fmt::format(" class=\"{}\"", words));
    }
    return document;
}

Result<SvgTemplate> SvgTemplate::parse(std::string document) {
    SvgTemplate out;
    const auto error = [&](std::size_t at, std::string_view reason) {
        return user_error(fmt::format("{}: {}", line_of(document, at), reason));
    };
    for (std::size_t at = document.find("{{"); at != std::string::npos; at = document.find("{{", at)) {
        const std::size_t close = document.find("}}", at);
        const std::size_t line_end = std::min(document.find('\n', at), document.size());
        if (close == std::string::npos || close > line_end) return error(at, "'{{' without '}}' on its line");
        const std::string inside = document.substr(at + 2, close - at - 2);
        const std::size_t first = std::min(inside.find_first_not_of(blanks), inside.size());
        const std::string word = inside.substr(first, inside.find_last_not_of(blanks) + 1 - first);
        const std::size_t colon = std::min(word.find(':'), word.size());
        Binding binding{.begin = at, .end = close + 2, .name = word.substr(0, colon)};
        if (!is_name(binding.name))
            return error(at, fmt::format("{{{{{}}}}}: allowed is a name of letters, digits, '_', '-' and '.'",
                                         printable(inside)));
        if (colon < word.size() && !read_form(word.substr(colon + 1), binding.digits, binding.decimals))
            return error(at, fmt::format("{{{{{}}}}}: allowed after ':' is a number's form of zeros, as 0, 000 or 0.00",
                                         printable(inside)));
        out.bindings_.push_back(std::move(binding));
        at = close + 2;
    }
    out.document_ = std::move(document);
    return out;
}

Result<std::string> SvgTemplate::fill(const HudValues& values) const {
    std::string out;
    out.reserve(document_.size() + 64 * bindings_.size());
    std::size_t at = 0;
    for (const Binding& binding : bindings_) {
        out.append(document_, at, binding.begin - at);
        at = binding.end;
        const auto found = values.find(binding.name);
        if (found == values.end()) {
            std::vector<std::string> names;
            for (const auto& [name, value] : values) names.push_back(name);
            return user_error(fmt::format("{}: {{{{{}}}}}: no value has this name{}", line_of(document_, binding.begin),
                                          binding.name, suggestion(binding.name, names)));
        }
        // In a style or an attribute it may still be a word of CSS that refers, which check_svg() refuses there.
        append_escaped(out, text_of(binding, found->second));
    }
    return out.append(document_, at);
}

std::string SvgTemplate::text_of(const Binding& binding, const HudValue& value) {
    const double* const number = std::get_if<double>(&value);
    if (number == nullptr) return printable(std::get<std::string>(value));
    if (binding.digits == 0 || !(std::abs(*number) < 1e15)) return fmt::format("{}", *number);
    std::string out = fmt::format("{:.{}f}", std::abs(*number), binding.decimals);
    const auto digits = std::min(out.find('.'), out.size());
    out.insert(0, static_cast<std::size_t>(binding.digits) - std::min(digits, static_cast<std::size_t>(binding.digits)),
               '0');
    // What is shown as nothing has no sign.
    const bool has_sign = *number < 0 && out.find_first_not_of("0.") != std::string::npos;
    if (has_sign) out.insert(0, 1, '-');
    return out;
}

bool SvgTemplate::shows(std::string_view name, const HudValue* before, const HudValue& after) const {
    return std::ranges::any_of(bindings_, [&](const Binding& binding) {
        return binding.name == name && (before == nullptr || text_of(binding, *before) != text_of(binding, after));
    });
}

}  // namespace darkroom
