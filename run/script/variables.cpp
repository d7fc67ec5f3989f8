// SPDX-License-Identifier: MIT
#include "script/variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/text/param_text.hpp"

namespace darkroom::script {

namespace {

std::string number_text(float value) {
    if (std::abs(value) >= 1e9f) return fmt::format("{}", value);
    std::string text = fmt::format("{:.6f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    const std::optional<double> again = parse_number(text);
    const bool is_same = again && static_cast<float>(*again) == value;
    if (!is_same) return fmt::format("{}", value);
    return text == "-0" ? "0" : text;
}

bool is_float(Kind kind) {
    return kind == Kind::Float || kind == Kind::Vec2 || kind == Kind::Vec3 || kind == Kind::Vec4 || kind == Kind::Rgb;
}

/// True: something was out of range.
bool clamp(const Range& range, ParamValue& value) {
    bool is_clamped = false;
    const auto one = [&](double& number) {
        const double inside = std::clamp(number, range.min, range.max);
        is_clamped = is_clamped || static_cast<float>(inside) != static_cast<float>(number);
        number = inside;
    };
    if (auto* const number = std::get_if<double>(&value)) one(*number);
    if (auto* const numbers = std::get_if<std::vector<double>>(&value))
        for (double& number : *numbers) one(number);
    return is_clamped;
}

/// Names in the code of a game that has the variables, beside those of its console.
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> other_names{
    {{"vid_gamma", "gamma"}, {"vid_contrast", "contrast"}}};

}  // namespace

std::optional<Variable> find_variable(const Composer& composer, std::string_view name) {
    if (const std::size_t dot = name.rfind('.'); dot != std::string_view::npos) {
        const std::optional<Handle> entry = composer.find(name.substr(0, dot));
        const ParamInfo* const row = entry ? composer.info(*entry)->parameters.find(name.substr(dot + 1)) : nullptr;
        if (row != nullptr) return Variable{*entry, row};
    }
    const auto* const other =
        std::ranges::find(other_names, name, &std::pair<std::string_view, std::string_view>::first);
    if (other != other_names.end()) name = other->second;
    for (std::size_t i = 0; i < composer.size(); ++i)
        for (const ParamInfo& row : composer.info(composer.entry(i))->parameters.rows)
            if (!row.also.empty() && row.also == name) return Variable{composer.entry(i), &row};
    return std::nullopt;
}

std::string name_of(const Composer& composer, const Variable& variable) {
    return fmt::format("{}.{}", composer.desc(variable.entry)->name, variable.row->name);
}

std::vector<NamedVariable> all_variables(const Composer& composer, std::string_view prefix) {
    std::vector<NamedVariable> out;
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const Handle entry = composer.entry(i);
        for (const ParamInfo& row : composer.info(entry)->parameters.rows) {
            const Variable variable{entry, &row};
            out.push_back({name_of(composer, variable), variable});
            const auto is_same = [&](const NamedVariable& other) { return other.name == row.also; };
            if (!row.also.empty() && std::ranges::none_of(out, is_same))
                out.push_back({std::string(row.also), variable});
        }
    }
    std::erase_if(out, [&](const auto& variable) { return !variable.name.starts_with(prefix); });
    std::ranges::stable_sort(out, {}, &NamedVariable::name);
    return out;
}

std::size_t variable_count(const Composer& composer) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < composer.size(); ++i) count += composer.info(composer.entry(i))->parameters.rows.size();
    return count;
}

std::string suggest_variable(const Composer& composer, std::string_view name) {
    std::vector<std::string> names;
    for (NamedVariable& variable : all_variables(composer)) names.push_back(std::move(variable.name));
    return suggestion(name, names);
}

std::string variable_text(const ParamInfo& row, std::span<const std::uint32_t> words) {
    const std::span<const std::uint32_t> own = words.subspan(row.word, row.words);
    if (is_float(row.kind)) {
        std::string out = number_text(std::bit_cast<float>(own[0]));
        for (const std::uint32_t word : own.subspan(1)) out.append(",").append(number_text(std::bit_cast<float>(word)));
        return out;
    }
    if (row.kind == Kind::Toggle) return own[0] != 0 ? "1" : "0";
    if (row.kind == Kind::Choice) return std::string(own[0] < row.choices.size() ? row.choices[own[0]] : "");
    if (row.kind == Kind::Curve) {
        std::string out;
        for (std::uint32_t i = 0; i < std::min<std::uint32_t>(own[0], Curve::capacity); ++i)
            out += fmt::format("{}{}:{}", i > 0 ? "," : "", number_text(std::bit_cast<float>(own[1 + i])),
                               number_text(std::bit_cast<float>(own[1 + Curve::capacity + i])));
        return out;
    }
    return format(row, words);
}

double variable_number(const ParamInfo& row, std::span<const std::uint32_t> words) {
    return parse_number(variable_text(row, words)).value_or(0);
}

Result<VariableValue> read_value(const ParamInfo& row, std::string_view name, std::string_view text) {
    auto value = parse_text(row, text);
    if (!value) return user_error(fmt::format("{}: {}", name, value.error().text));
    if (row.kind != Kind::Choice && std::holds_alternative<std::string>(*value))
        return user_error(fmt::format("{} = {}: allowed here is {} without %", name, printable(text), interval(row)));
    const bool is_clamped = (is_float(row.kind) || row.kind == Kind::Int) && clamp(row.range, *value);
    std::vector<std::uint32_t> words(row.word + row.words);
    DARKROOM_TRY(assign(row, words, *value, name));
    VariableValue out;
    if (is_clamped)
        out.remark = fmt::format("{} = {}: allowed is {}, set to {}", name, printable(text), interval(row),
                                 variable_text(row, words));
    out.words.assign(words.begin() + row.word, words.end());
    return out;
}

}  // namespace darkroom::script
