// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "info_documents.hpp"

namespace app::info {

namespace {

std::string shown_key(std::string_view key) {
    std::string out(key);
    std::ranges::replace(out, '_', ' ');
    return out;
}

bool is_size(std::string_view key) { return key == "size" || key.ends_with("_size"); }

// One line: numbers and texts as they are, arrays with commas, objects as "key = value".
std::string line_of(const Json& value, std::string_view key) {
    if (value.is_null()) return "-";
    if (value.is_boolean()) return value.boolean() ? "yes" : "no";
    if (value.is_text()) {
        const std::string& text = value.text();
        return text.empty() ? "-" : darkroom::printable(text);
    }
    if (value.is_number() && !value.is_whole()) return fmt::format("{:.6g}", value.number());
    std::string out;
    if (value.is_array()) {
        for (const Json& item : value.elements())
            out += fmt::format("{}{}", out.empty() ? "" : is_size(key) ? " x " : ", ", line_of(item, key));
        return out.empty() ? "-" : out;
    }
    if (!value.is_object()) return value.dump();
    for (const auto& [name, item] : value.members()) {
        const std::string text = item.is_array() ? fmt::format("[{}]", line_of(item, name)) : line_of(item, name);
        out += fmt::format("{}{} = {}", out.empty() ? "" : ", ", shown_key(name), text);
    }
    return out.empty() ? "-" : out;
}

bool is_table(const Json& value) { return value.is_array() && !value.empty() && value.elements().front().is_object(); }

// Sentences, each of which takes a line of its own.
bool is_list(const Json& value) {
    return value.is_array() && std::ranges::any_of(value.elements(), [](const Json& item) {
               return item.is_text() && item.text().find(' ') != std::string::npos;
           });
}

std::string table_of(const Json& rows, std::string_view indent) {
    std::vector<std::string> keys;
    for (const Json& row : rows.elements())
        for (const auto& [key, value] : row.members())
            if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
    std::vector<std::vector<std::string>> lines(1);
    for (const std::string& key : keys) lines[0].push_back(shown_key(key));
    for (const Json& row : rows.elements()) {
        std::vector<std::string>& line = lines.emplace_back();
        for (const std::string& key : keys) {
            const Json* const value = row.find(key);
            line.push_back(value == nullptr ? "-" : line_of(*value, key));
        }
    }
    std::vector<std::size_t> widths(keys.size());
    for (const std::vector<std::string>& line : lines)
        for (std::size_t i = 0; i + 1 < keys.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
    std::string out;
    for (const std::vector<std::string>& line : lines) {
        std::string text = fmt::format("{} ", indent);
        for (std::size_t i = 0; i < keys.size(); ++i) text += fmt::format(" {:<{}} ", line[i], widths[i]);
        text.erase(text.find_last_not_of(' ') + 1);
        out += text + '\n';
    }
    return out;
}

std::string lines_of(const Json& object, std::string_view indent) {
    std::size_t width = 0;
    for (const auto& [key, value] : object.members())
        if (!value.is_object() && !is_table(value) && !is_list(value)) width = std::max(width, key.size());
    std::string out;
    for (const auto& [key, value] : object.members()) {
        const std::string name = shown_key(key);
        if (value.is_object()) {
            out += fmt::format("{}{}:\n{}", indent, name, lines_of(value, std::string(indent) + "  "));
        } else if (is_table(value)) {
            out += fmt::format("{}{}:\n{}", indent, name, table_of(value, indent));
        } else if (is_list(value)) {
            out += fmt::format("{}{}:\n", indent, name);
            for (const Json& item : value.elements()) out += fmt::format("{}  {}\n", indent, line_of(item, key));
        } else {
            out += fmt::format("{}{:<{}}  {}\n", indent, name, width, line_of(value, key));
        }
    }
    return out;
}

}  // namespace

std::string text_of(const Json& document) { return lines_of(document, ""); }

}  // namespace app::info
