// SPDX-License-Identifier: MIT
// The code of toml++, which stands here alone, is compiled with what its headers define.
#define TOML_IMPLEMENTATION
#include "toml/toml_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cctype>

namespace darkroom {

namespace {

// Dots of one line beside those of numbers. A dotted key makes a table for each dot, however long it is, and tables are
// destroyed by recursion, so their number is bounded before the text is parsed.
constexpr std::size_t max_dots = 64;

// Of the whole text: a table takes some 200 bytes, and its dot two.
constexpr std::size_t most_dots = 1U << 18U;

std::size_t dots_of_keys(std::string_view line) {
    const auto is_digit = [&](std::size_t i) {
        return i < line.size() && std::isdigit(static_cast<unsigned char>(line[i])) != 0;
    };
    const std::size_t first = line.find_first_not_of(" \t");
    const bool is_comment = first != std::string_view::npos && line[first] == '#';
    if (is_comment && line.find_first_of("\"'") == std::string_view::npos) return 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] != '.') continue;
        std::size_t start = i;
        while (start > 0 && is_digit(start - 1)) --start;
        const bool has_digits = start < i && is_digit(i + 1);
        const bool is_number =
            has_digits && (start == 0 || std::string_view(" \t,[=+-").find(line[start - 1]) != std::string_view::npos);
        if (!is_number) ++count;
    }
    return count;
}

std::optional<std::vector<double>> numbers_of(const toml::array& array) {
    std::vector<double> out;
    for (const toml::node& node : array) {
        if (!node.is_number()) return std::nullopt;
        out.push_back(*node.value<double>());
    }
    return out;
}

std::optional<ParamValue> value_of_array(const toml::array& array) {
    if (std::optional<std::vector<double>> numbers = numbers_of(array)) return ParamValue(std::move(*numbers));
    CurvePoints points;
    for (const toml::node& node : array) {
        const toml::array* const pair = node.as_array();
        const std::optional<std::vector<double>> numbers = pair == nullptr ? std::nullopt : numbers_of(*pair);
        if (!numbers || numbers->size() != 2) return std::nullopt;
        points.push_back({(*numbers)[0], (*numbers)[1]});
    }
    return ParamValue(std::move(points));
}

std::optional<ParamValue> value_of_table(const toml::table& table) {
    for (const std::string_view letters : {"xyzw", "xyz", "xy", "rgb"}) {
        if (table.size() != letters.size()) continue;
        std::vector<double> numbers;
        for (const char letter : letters)
            if (const std::optional<double> number = table[std::string_view(&letter, 1)].value<double>())
                numbers.push_back(*number);
        if (numbers.size() == letters.size()) return ParamValue(std::move(numbers));
    }
    return std::nullopt;
}

/// Of a line like `exposure = 2ev`, which is no TOML: what to type instead.
std::string unit_hint(std::string_view text, std::size_t line) {
    for (; line > 1; --line) text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    text = text.substr(0, text.find_first_of("\r\n"));
    const std::size_t equals = std::min(text.find('='), text.size());
    text.remove_prefix(std::min(text.find_first_not_of("= \t", equals), text.size()));
    text = text.substr(0, text.find_first_of(" \t#,]}"));
    const std::size_t unit = std::min(text.find_first_not_of("+-.0123456789"), text.size());
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    if (unit == 0 || unit == text.size() || text.find_first_not_of(letters, unit) != std::string_view::npos) return {};
    return fmt::format("; a number with a unit is a text: \"{}\"", printable(text));
}

}  // namespace

Result<toml::table> parse_toml(std::string_view text, std::string_view shown_name) {
    if (text.size() > most_toml_bytes)
        return user_error(fmt::format("{}: {} bytes, at most {} are read", shown_name, text.size(), most_toml_bytes));
    std::size_t line = 1, dots = 0;
    for (std::size_t start = 0; start < text.size(); ++line) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        const std::size_t own = dots_of_keys(text.substr(start, end - start));
        if (own > max_dots)
            return user_error(fmt::format("{}:{}:1: the line holds more than {} dots, keys may not nest so deep",
                                          shown_name, line, max_dots));
        dots += own;
        if (dots > most_dots)
            return user_error(fmt::format("{}:{}:1: more than {} dots in keys", shown_name, line, most_dots));
        start = end + 1;
    }
    toml::parse_result parsed = toml::parse(text);
    if (!parsed) {
        const toml::source_region& place = parsed.error().source();
        return user_error(fmt::format("{}:{}:{}: {}{}", shown_name, place.begin.line, place.begin.column,
                                      printable(parsed.error().description()), unit_hint(text, place.begin.line)));
    }
    return std::move(parsed).table();
}

std::optional<ParamValue> value_of(const toml::node& node) {
    if (const auto* value = node.as_boolean()) return ParamValue(value->get());
    if (const auto* value = node.as_integer()) return ParamValue(value->get());
    if (const auto* value = node.as_floating_point()) return ParamValue(value->get());
    if (const auto* value = node.as_string()) return ParamValue(value->get());
    if (const auto* array = node.as_array()) return value_of_array(*array);
    if (const auto* table = node.as_table()) return value_of_table(*table);
    return std::nullopt;
}

Result<std::optional<ParamValue>> value_for(const ParamInfo& row, const toml::node& node) {
    const auto* const text = node.as_string();
    const bool is_number = row.kind != Kind::Choice && row.kind != Kind::Toggle;
    if (!is_number || text == nullptr || parse_number(text->get())) return value_of(node);
    Result<ParamValue> parsed = parse_text(row, text->get());
    if (!parsed) return failure(std::move(parsed));
    return std::optional<ParamValue>(std::move(*parsed));
}

std::string show(const toml::node& node) {
    if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
    if (const auto* value = node.as_integer()) return fmt::format("{}", value->get());
    if (const auto* value = node.as_floating_point()) return fmt::format("{}", value->get());
    if (const auto* value = node.as_string()) return fmt::format("\"{}\"", printable(value->get()));
    if (node.is_array()) return "an array";
    if (node.is_table()) return "a table";
    return "a date or time";
}

}  // namespace darkroom
