// SPDX-License-Identifier: MIT
// A Console's variables and its configuration file. Commands are in commands.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/caught.hpp"
#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "script/console_state.hpp"

namespace darkroom {

namespace {

constexpr std::size_t longest_file = std::size_t{1} << 20;

/// Words of a command hold neither quotes nor control bytes.
bool is_sayable(std::string_view text) {
    return std::ranges::none_of(text, [](char letter) {
        return letter == '"' || static_cast<unsigned char>(letter) < ' ' || letter == '\x7f';
    });
}

}  // namespace

Result<script::Variable> Console::State::variable(std::string_view name, bool suggests) const {
    if (const auto found = script::find_variable(*composer, name)) return *found;
    return user_error(fmt::format("'{}': no such variable{}", printable(name),
                                  suggests ? script::suggest_variable(*composer, name) : ""));
}

std::span<const std::uint32_t> Console::State::defaults(const script::Variable& variable) const {
    const std::span<const std::uint32_t> effect = composer->info(variable.entry)->parameters.defaults;
    const auto taken = entry_defaults.find(variable.entry.id);
    // Another effect may have come in an entry's place.
    return taken != entry_defaults.end() && taken->second.size() == effect.size() ? taken->second : effect;
}

bool Console::State::is_read_only(const script::Variable& variable) const {
    return variable.row->kind == Kind::Resource || locked.contains(script::name_of(*composer, variable));
}

bool Console::State::is_archived(const script::Variable& variable) const {
    return variable.row->is_archived || archived.contains(script::name_of(*composer, variable));
}

std::string Console::State::text(const script::Variable& variable) const {
    return script::variable_text(*variable.row, composer->words(variable.entry));
}

Result<std::string> Console::State::write(std::string_view name, const script::Variable& variable,
                                          std::string_view value, std::optional<std::string_view> owner) {
    const std::string shown = printable(name);
    if (is_read_only(variable)) return user_error(fmt::format("{} is read-only", shown));
    DARKROOM_TRY_VALUE(auto read, script::read_value(*variable.row, shown, value));
    const std::string_view row = variable.row->name;
    DARKROOM_TRY(owner ? composer->set_override(variable.entry, row, *owner, read.words)
                       : composer->set(variable.entry, row, read.words));
    if (!owner) set_by_hand.insert(script::name_of(*composer, variable));
    return std::move(read.remark);
}

Console::Console(Composer& composer, ConsoleDesc desc) : state_(std::make_unique<State>()) {
    state_->composer = &composer;
    state_->desc = std::move(desc);
    if (!state_->desc.print) state_->desc.print = [](Severity, std::string_view) {};
    take_defaults();
}
Console::Console(Console&&) noexcept = default;
Console& Console::operator=(Console&&) noexcept = default;
Console::~Console() = default;

Composer& Console::composer() const { return *state_->composer; }

std::uint32_t Console::execute(std::string_view commands, const ExecuteOptions& options) try {
    return script::run_commands(*state_, commands, {.execute = options});
} catch (...) {
    (options.print ? options.print : state_->desc.print)(Severity::Error, "out of memory");
    return 1;
}

bool Console::has(std::string_view name) const { return script::find_variable(*state_->composer, name).has_value(); }

std::optional<std::string> Console::get(std::string_view name) const {
    const auto variable = script::find_variable(*state_->composer, name);
    return variable ? std::optional(state_->text(*variable)) : std::nullopt;
}

std::optional<double> Console::number(std::string_view name) const {
    const auto variable = script::find_variable(*state_->composer, name);
    if (!variable) return std::nullopt;
    return script::variable_number(*variable->row, state_->composer->words(variable->entry));
}

Result<std::string> Console::set(std::string_view name, std::string_view value) try {
    const auto variable = state_->variable(name);
    return variable ? state_->write(name, *variable, value) : failure(variable.error());
} catch (...) {
    return caught("set");
}

Result<std::string> Console::set_override(std::string_view name, std::string_view owner, std::string_view value) try {
    const auto variable = state_->variable(name);
    return variable ? state_->write(name, *variable, value, owner) : failure(variable.error());
} catch (...) {
    return caught("set_override");
}

std::vector<std::string> Console::names(std::string_view prefix) const {
    std::vector<std::string> out;
    for (script::NamedVariable& variable : script::all_variables(*state_->composer, prefix))
        out.push_back(std::move(variable.name));
    return out;
}

std::vector<std::string> Console::words(std::string_view prefix) const {
    std::vector<std::string> out = names(prefix);
    std::ranges::copy(script::command_names(prefix), std::back_inserter(out));
    std::ranges::sort(out);
    return out;
}

void Console::take_defaults() {
    const Composer& composer = *state_->composer;
    state_->entry_defaults.clear();
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const std::span<const std::uint32_t> words = composer.words(composer.entry(i));
        state_->entry_defaults[composer.entry(i).id].assign(words.begin(), words.end());
    }
}

bool Console::lock(std::string_view name, bool is_locked) {
    const auto variable = script::find_variable(*state_->composer, name);
    if (!variable) return false;
    const std::string own = script::name_of(*state_->composer, *variable);
    if (is_locked)
        state_->locked.insert(own);
    else
        state_->locked.erase(own);
    return true;
}

Result<> Console::read_config(const std::filesystem::path& path) try {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return {};
    DARKROOM_TRY_VALUE(const auto content, read_file(path, {.max_size = longest_file}));
    const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
    script::RunOptions options;
    options.place = path.string();
    options.kept = &state_->kept;
    script::run_commands(*state_, text, options);
    return {};
} catch (...) {
    return caught("read_config");
}

Result<> Console::write_config(const std::filesystem::path& path) const try {
    const Composer& composer = *state_->composer;
    std::map<std::string, std::string> lines = state_->kept;
    for (const auto& [name, variable] : script::all_variables(composer)) {
        if (!state_->is_archived(variable) || state_->is_read_only(variable)) continue;
        // One line for each: under the name that outlives another look, if the variable has one.
        const std::optional<script::Variable> first = script::find_variable(composer, variable.row->also);
        const bool has_other_name = first && first->entry == variable.entry && first->row == variable.row;
        if (has_other_name ? name != variable.row->also : !is_sayable(name)) continue;
        // The values of a look are its own, and not those of the next one.
        const std::string own = script::name_of(composer, variable);
        if (!state_->set_by_hand.contains(own)) continue;
        const bool is_asked_for = state_->archived.contains(own);
        lines[name] = fmt::format("{}\"{}\" \"{}\"", is_asked_for ? "seta " : "", name, state_->text(variable));
    }
    std::string text = "// Written by the program; variables that are archived.\n";
    for (const auto& [name, line] : lines) text += line + "\n";
    return write_file(path, std::as_bytes(std::span(text)));
} catch (...) {
    return caught("write_config");
}

}  // namespace darkroom

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
    // As looks and flags have it: bloom_intensity, --bloom-intensity.
    std::string key(name.starts_with("--") ? name.substr(2) : name);
    std::ranges::replace(key, '-', '_');
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const EffectInfo& effect = *composer.info(composer.entry(i));
        if (!key.starts_with(effect.name)) continue;
        for (const ParamInfo& row : effect.parameters.rows)
            if (flat_key(effect.name, row.name) == key) return Variable{composer.entry(i), &row};
    }
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
