// SPDX-License-Identifier: MIT
#include "json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace app {

namespace {

using Parsed = nlohmann::ordered_json;

// Ours are read and destroyed by recursion, which a file of brackets alone would lead through the stack's end.
constexpr int max_depth = 64;

std::optional<Json> json_of(const Parsed& parsed, int depth = 0) {
    if (depth > max_depth) return std::nullopt;
    switch (parsed.type()) {
        case Parsed::value_t::boolean:
            return parsed.get<bool>();
        case Parsed::value_t::number_integer:
            return parsed.get<std::int64_t>();
        case Parsed::value_t::number_unsigned:
            if (parsed.get<std::uint64_t>() <= std::numeric_limits<std::int64_t>::max())
                return parsed.get<std::int64_t>();
            return parsed.get<double>();
        case Parsed::value_t::number_float:
            return parsed.get<double>();
        case Parsed::value_t::string:
            return parsed.get_ref<const std::string&>();
        case Parsed::value_t::array: {
            Json out = Json::array();
            for (const Parsed& item : parsed) {
                std::optional<Json> found = json_of(item, depth + 1);
                if (!found) return std::nullopt;
                out.push_back(std::move(*found));
            }
            return out;
        }
        case Parsed::value_t::object: {
            Json out = Json::object();
            for (const auto& [key, value] : parsed.items()) {
                std::optional<Json> found = json_of(value, depth + 1);
                if (!found) return std::nullopt;
                out[key] = std::move(*found);
            }
            return out;
        }
        default:
            return Json();
    }
}

Parsed parsed_of(const Json& json) {
    if (json.is_boolean()) return json.boolean();
    if (json.is_whole()) return json.whole();
    if (json.is_number()) return json.number();
    if (json.is_text()) return json.text();
    if (json.is_array()) {
        Parsed out = Parsed::array();
        for (const Json& item : json.elements()) out.push_back(parsed_of(item));
        return out;
    }
    if (!json.is_object()) return nullptr;
    Parsed out = Parsed::object();
    for (const auto& [key, value] : json.members()) out[key] = parsed_of(value);
    return out;
}

}  // namespace

Json::Json() = default;
Json::Json(const Json& other) = default;
Json::Json(Json&& other) noexcept = default;
Json& Json::operator=(const Json& other) = default;
Json& Json::operator=(Json&& other) noexcept = default;
Json::~Json() = default;

void Json::set(bool value) { value_ = value; }
void Json::set(std::int64_t value) { value_ = value; }
void Json::set(double value) { value_ = value; }
Json::Json(std::string text) : value_(std::move(text)) {}

Json::Json(std::initializer_list<Json> list) {
    const auto is_member = [](const Json& item) {
        return item.is_array() && item.size() == 2 && item.elements().front().is_text();
    };
    if (!std::ranges::all_of(list, is_member)) {
        value_ = std::vector<Json>(list);
        return;
    }
    value_ = std::vector<Member>();
    for (const Json& item : list) (*this)[item.elements()[0].text()] = item.elements()[1];
}

Json Json::array() {
    Json out;
    out.value_ = std::vector<Json>();
    return out;
}

Json Json::object() {
    Json out;
    out.value_ = std::vector<Member>();
    return out;
}

std::optional<Json> Json::parse(std::string_view text) {
    const Parsed parsed = Parsed::parse(text.begin(), text.end(), nullptr, false);
    if (parsed.is_discarded()) return std::nullopt;
    return json_of(parsed);
}

Json Json::value_or_text(std::string_view text) { return parse(text).value_or(Json(text)); }

bool Json::is_null() const { return std::holds_alternative<std::monostate>(value_); }
bool Json::is_boolean() const { return std::holds_alternative<bool>(value_); }
bool Json::is_whole() const { return std::holds_alternative<std::int64_t>(value_); }
bool Json::is_number() const { return is_whole() || std::holds_alternative<double>(value_); }
bool Json::is_text() const { return std::holds_alternative<std::string>(value_); }
bool Json::is_array() const { return std::holds_alternative<std::vector<Json>>(value_); }
bool Json::is_object() const { return std::holds_alternative<std::vector<Member>>(value_); }

bool Json::boolean() const { return std::get<bool>(value_); }

std::int64_t Json::whole() const { return std::get<std::int64_t>(value_); }

double Json::number() const { return is_whole() ? static_cast<double>(whole()) : std::get<double>(value_); }

const std::string& Json::text() const { return std::get<std::string>(value_); }
const std::vector<Json>& Json::elements() const { return std::get<std::vector<Json>>(value_); }
const std::vector<Json::Member>& Json::members() const { return std::get<std::vector<Member>>(value_); }

std::size_t Json::size() const {
    if (is_array()) return elements().size();
    if (is_object()) return members().size();
    return is_null() ? 0 : 1;
}

const Json* Json::find(std::string_view key) const {
    if (!is_object()) return nullptr;
    const auto found = std::ranges::find(members(), key, &Member::key);
    return found == members().end() ? nullptr : &found->value;
}

Json& Json::operator[](std::string_view key) {
    if (is_null()) value_ = std::vector<Member>();
    auto& all = std::get<std::vector<Member>>(value_);
    const auto found = std::ranges::find(all, key, &Member::key);
    return found == all.end() ? all.emplace_back(Member{std::string(key), Json()}).value : found->value;
}

void Json::push_back(Json value) {
    if (is_null()) value_ = std::vector<Json>();
    std::get<std::vector<Json>>(value_).push_back(std::move(value));
}

void Json::update(const Json& other) {
    for (const auto& [key, value] : other.members()) (*this)[key] = value;
}

std::string Json::dump(std::optional<int> indent) const {
    return parsed_of(*this).dump(indent.value_or(-1), ' ', false, Parsed::error_handler_t::replace);
}

Json json_number(double value) {
    if (std::isfinite(value)) return value;
    return std::isnan(value) ? "nan" : fmt::format("{}", value);
}

}  // namespace app
