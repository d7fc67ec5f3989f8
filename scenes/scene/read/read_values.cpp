// SPDX-License-Identifier: MIT
#include "scene/read/read_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/text/param_text.hpp"

namespace darkroom::scene::reading {

namespace {

std::string show(const Interval& allowed) {
    const std::string unit = allowed.unit.empty() ? std::string() : fmt::format(" {}", allowed.unit);
    if (allowed.is_open) return fmt::format("({}, {}){}", allowed.low, allowed.high, unit);
    return fmt::format("[{}, {}]{}", allowed.low, allowed.high, unit);
}

std::string list_of(std::span<const std::string_view> names) {
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i)
        out += fmt::format("{}{}", i == 0 ? "" : i + 1 == names.size() ? " or " : ", ", names[i]);
    return out;
}

std::string shown(std::span<const float> numbers) {
    return numbers.size() == 1 ? fmt::format("{}", numbers[0]) : fmt::format("[{}]", fmt::join(numbers, ", "));
}

}  // namespace

std::string Where::text() const {
    std::string out = up == nullptr ? std::string() : up->text();
    if (!out.empty()) out += '.';
    out += printable(name);
    if (index) out += fmt::format("[{}]", *index);
    return out;
}

Place TableReader::place_of_value(std::string_view key) const {
    const Value* const value = find(table_, key);
    return value == nullptr ? table_.place : value->place;
}

bool TableReader::is_number(std::string_view key) const {
    const Value* const value = find(table_, key);
    return value != nullptr && value->node->is_number();
}

std::string TableReader::name(std::string_view key) const { return fmt::format("{}.{}", where_.text(), key); }

const Value* TableReader::take(std::string_view key) {
    known_.push_back(key);
    const Value* const value = find(table_, key);
    if (value != nullptr) ++taken_;
    return value;
}

std::string TableReader::used(std::string_view what) const {
    if (reader_.report.is_strict() || what.empty()) return {};
    return fmt::format("; {} is used", what);
}

void TableReader::wrong_kind(std::string_view key, const Value& value, std::string_view expected) {
    is_wrong_ = true;
    report().error(value.place,
                   [&] { return fmt::format("{} = {}: expected {}", name(key), reading::show(value), expected); });
}

void TableReader::slip(std::string_view key, std::string_view text) {
    if (is_wrong_) return;
    report().slip(place_of_value(key), [&] {
        const Value* const value = find(table_, key);
        return fmt::format("{} = {}: {}", name(key), value == nullptr ? "nothing" : reading::show(*value), text);
    });
}

std::optional<double> TableReader::number_of(const toml::node& node, Place place, std::string_view key,
                                             Interval allowed, std::string_view used_text) {
    const std::optional<double> number = node.is_number() ? node.value<double>() : std::nullopt;
    if (!number || !std::isfinite(*number)) {
        is_wrong_ = true;
        report().error(place, [&] {
            return fmt::format("{} = {}: expected a {}number, allowed is {}", name(key), darkroom::show(node),
                               number ? "finite " : "", show(allowed));
        });
        return std::nullopt;
    }
    if (allowed.holds(*number)) return number;
    report().slip(place, [&] {
        return fmt::format("{} = {}: allowed is {}{}", name(key), darkroom::show(node), show(allowed), used(used_text));
    });
    return std::nullopt;
}

std::optional<double> TableReader::number_at(std::string_view key, Interval allowed, std::string_view used_text) {
    const Value* const value = take(key);
    if (value == nullptr) return std::nullopt;
    return number_of(*value->node, value->place, key, allowed, used_text);
}

bool TableReader::number(std::string_view key, double& out, Interval allowed) {
    const std::optional<double> number = number_at(key, allowed, has(key) ? fmt::format("{}", out) : "");
    if (number) out = *number;
    return number.has_value();
}

bool TableReader::number(std::string_view key, float& out, Interval allowed) {
    const std::optional<double> number = number_at(key, allowed, has(key) ? fmt::format("{}", out) : "");
    if (number) out = static_cast<float>(*number);
    return number.has_value();
}

bool TableReader::number(std::string_view key, std::optional<float>& out, Interval allowed) {
    const std::optional<double> number = number_at(key, allowed, "the default");
    if (number) out = static_cast<float>(*number);
    return number.has_value();
}

bool TableReader::count(std::string_view key, std::uint32_t& out, std::uint32_t low, std::uint32_t high) {
    const Value* const value = take(key);
    if (value == nullptr) return false;
    const Interval allowed{.low = static_cast<double>(low), .high = static_cast<double>(high)};
    // What is below all that is allowed stands for nothing said.
    const std::string used_text = out < low ? "the default" : fmt::format("{}", out);
    const std::optional<double> number = number_of(*value->node, value->place, key, allowed, used_text);
    if (!number) return false;
    if (std::floor(*number) != *number) {
        wrong_kind(key, *value, fmt::format("a whole number, allowed is {}", show(allowed)));
        return false;
    }
    out = static_cast<std::uint32_t>(*number);
    return true;
}

bool TableReader::flag(std::string_view key, bool& out) {
    const Value* const value = take(key);
    if (value == nullptr) return false;
    const auto* const flag = value->node->as_boolean();
    if (flag == nullptr) {
        wrong_kind(key, *value, "true or false");
        return false;
    }
    out = flag->get();
    return true;
}

bool TableReader::text(std::string_view key, std::string& out, std::size_t longest) {
    const Value* const value = take(key);
    if (value == nullptr) return false;
    if (!value->is_text() || value->text.size() > longest || value->text.find('\0') != std::string_view::npos) {
        wrong_kind(key, *value, fmt::format("a text of up to {} bytes", longest));
        return false;
    }
    out = value->text;
    return true;
}

bool TableReader::path(std::string_view key, std::filesystem::path& out) {
    std::string name;
    if (!text(key, name)) return false;
    out = name;
    return true;
}

unsigned TableReader::numbers_of_array(const Value& value, std::string_view key, std::span<float> out,
                                       std::string_view letters, std::size_t fewest, Interval allowed) {
    const toml::array& array = *value.node->as_array();
    if (array.size() < fewest || array.size() > letters.size()) {
        wrong_kind(key, value,
                   fewest == letters.size() ? fmt::format("{} numbers", fewest)
                                            : fmt::format("{} or {} numbers", fewest, letters.size()));
        return 0;
    }
    std::array<float, 4> numbers{};
    for (std::size_t i = 0; i < array.size(); ++i) {
        const toml::node& node = array[i];
        const Place place = reading::place_of(node.source(), value.place.file);
        const std::string element = fmt::format("{}[{}]", key, i);
        const std::optional<double> number = number_of(node, place, element, allowed, shown(out.subspan(i, 1)));
        if (!number && (!node.is_number() || !std::isfinite(*node.value<double>()))) return 0;
        numbers[i] = number ? static_cast<float>(*number) : out[i];
    }
    std::copy_n(numbers.begin(), array.size(), out.begin());
    return (1U << array.size()) - 1;
}

unsigned TableReader::numbers_of_table(const Value& value, std::string_view key, std::span<float> out,
                                       std::string_view letters, Interval allowed) {
    const Where where{.up = &where_, .name = key};
    TableReader table(reader_, value, where);
    unsigned given = 0;
    for (std::size_t i = 0; i < letters.size(); ++i)
        if (table.number(letters.substr(i, 1), out[i], allowed)) given |= 1U << i;
    table.finish();
    is_wrong_ = is_wrong_ || table.is_wrong_ || given == 0;
    return given;
}

unsigned TableReader::numbers_at(std::string_view key, std::span<float> out, std::string_view letters,
                                 std::size_t fewest, Interval allowed) {
    const Value* const value = take(key);
    if (value == nullptr) return 0;
    if (value->is_table()) return numbers_of_table(*value, key, out, letters, allowed);
    if (value->node->is_array()) return numbers_of_array(*value, key, out, letters, fewest, allowed);
    std::vector<std::string> names;
    for (const char letter : letters.substr(0, fewest)) names.emplace_back(1, letter);
    wrong_kind(key, *value,
               fmt::format("{} numbers as an array [{}] or a table of {}", fewest, fmt::join(names, ", "),
                           fmt::join(names, ", ")));
    return 0;
}

bool TableReader::vector(std::string_view key, vec3& out, Interval allowed) {
    return numbers_at(key, {&out.x, 3}, "xyz", 3, allowed) != 0;
}

bool TableReader::rotation_quaternion(std::string_view key, quat& out) {
    std::array<float, 4> numbers{out.x, out.y, out.z, out.w};
    if (numbers_at(key, numbers, "xyzw", 4, {.low = -1e6, .high = 1e6}) == 0) return false;
    const quat given(numbers[3], numbers[0], numbers[1], numbers[2]);
    const float length = glm::length(given);
    if (length < 1e-6F) {
        slip(key, "a rotation needs a length above 0" + used("no rotation"));
        return false;
    }
    out = given / length;
    return true;
}

bool TableReader::color(std::string_view key, vec3& out, std::optional<float>* alpha) {
    std::array<float, 4> numbers{out.x, out.y, out.z, 1};
    const unsigned given = numbers_at(key, numbers, "rgba", 3, light_values);
    if (given == 0) return false;
    out = {numbers[0], numbers[1], numbers[2]};
    if ((given & 8U) == 0) return true;
    if (alpha == nullptr)
        slip(key, "alpha means nothing here, allowed are 3 numbers");
    else if (fraction.holds(numbers[3]))
        *alpha = numbers[3];
    else
        slip(key, fmt::format("alpha is {}, allowed is {}{}", numbers[3], show(fraction), used("1")));
    return true;
}

bool TableReader::color(std::string_view key, vec4& out) {
    vec3 rgb(out);
    std::optional<float> alpha;
    if (!color(key, rgb, &alpha)) return false;
    out = vec4(rgb, alpha.value_or(out.w));
    return true;
}

std::optional<std::size_t> TableReader::choice_at(std::string_view key, std::span<const std::string_view> names,
                                                  std::string_view current) {
    const Value* const value = take(key);
    if (value == nullptr) return std::nullopt;
    if (!value->is_text()) {
        wrong_kind(key, *value, list_of(names));
        return std::nullopt;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == value->text) return i;
    report().slip(value->place, [&] {
        const std::vector<std::string> known(names.begin(), names.end());
        return fmt::format("{} = \"{}\"{}{}", name(key), printable(value->text), alternatives(value->text, known),
                           used(current));
    });
    return std::nullopt;
}

std::vector<Value> TableReader::tables(std::string_view key) {
    const Value* const value = take(key);
    if (value == nullptr) return {};
    const toml::array* const array = value->node->as_array();
    std::vector<Value> out;
    if (array != nullptr && array->size() > reader_.keys_left) {
        report().error(value->place,
                       [&] { return fmt::format("{}: the paths of a scene have too many keys", name(key)); });
        return out;
    }
    bool is_good = array != nullptr;
    if (array != nullptr)
        for (const toml::node& node : *array) {
            is_good = is_good && node.is_table();
            if (is_good) out.push_back(reader_.trees.build(node, value->place.file));
        }
    reader_.keys_left -= out.size();
    if (is_good) return out;
    wrong_kind(key, *value, "an array of tables");
    return {};
}

void TableReader::finish() {
    if (taken_ == table_.members.size()) return;
    std::sort(known_.begin(), known_.end());
    for (const Member& member : table_.members) {
        if (std::binary_search(known_.begin(), known_.end(), member.key)) continue;
        report().slip(member.place, [&] {
            const std::vector<std::string> known(known_.begin(), known_.end());
            return fmt::format("unknown key '{}' = {} in {}{}", printable(member.key), reading::show(member.value),
                               where_.text(), report().suggestion(member.key, known));
        });
    }
}

}  // namespace darkroom::scene::reading
