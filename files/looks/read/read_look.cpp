// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <darkroom/look.hpp>

#include "core/caught.hpp"
#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/read/look_reader.hpp"

namespace darkroom {

Result<Look> LookReader::read(const toml::table& file) {
    read_top(file);
    if (options_.is_scene) read_lens(file);
    const toml::node* const flat = file.get("post_process");
    const toml::node* const stack = file.get("stack");
    if (flat != nullptr && stack != nullptr)
        report(*stack, Weight::Wrong, "[[stack]] beside [post_process]: a look has one of them");
    Look look = stack != nullptr ? read_stack(*this, *stack) : read_flat(*this, flat);
    if (const toml::node* const ui = file.get("ui")) read_ui(*this, look, *ui);
    if (options_.allows_modulation) read_modulation(*this, file, look);
    return finish(std::move(look));
}

/// What an unknown key at the top was meant to be: one of the flat table, or misspelt.
static std::string meant_at_top(const std::string& key, std::span<const std::string> names) {
    Look look = default_look();
    if (key == "order" || key == "enabled" || find_target(look, key, {})) return ": it belongs below [post_process]";
    std::string near = suggestion(key, names);
    if (!near.empty()) return near;
    std::vector<std::string> flat;
    for (const LookEntry& entry : look.entries)
        for (const ParamInfo& row : entry.effect->parameters.rows)
            flat.push_back(flat_key(entry.effect->name, row.name));
    near = nearest(key, flat);
    return near.empty() ? near : fmt::format(", did you mean '{}' below [post_process]?", near);
}

void LookReader::read_top(const toml::table& file) {
    const std::vector<std::string> names{"format", "post_process", "stack", "ui", "pulse", "layer"};
    // Of a scene's other tables the reader of scenes reports what it does not know.
    for (const auto& [key, node] : file)
        if (!options_.is_scene && std::find(names.begin(), names.end(), key.str()) == names.end())
            report(key.source().begin, Weight::Slip,
                   fmt::format("unknown key '{}'{}", printable(key.str()),
                               problems_.size() < max_suggestions ? meant_at_top(std::string(key.str()), names) : ""));
    const toml::node* const format = file.get("format");
    if (format == nullptr) return;
    const auto* const number = format->as_integer();
    if (number == nullptr)
        report(*format, Weight::Wrong, fmt::format("format is no whole number: format = {} is", Look::format));
    else if (number->get() != Look::format)
        report(*format, Weight::Wrong,
               fmt::format("format = {}: this build reads format {}", show(*format), Look::format));
}

void LookReader::read_lens(const toml::table& file) {
    const toml::table* const camera = file["camera"].as_table();
    if (camera == nullptr) return;
    for (const LensKey& key : lens_keys)
        if (const std::optional<double> value = (*camera)[key.key].value<double>(); value && !(lens_.*key.member))
            lens_.*key.member = static_cast<float>(*value);
}

void LookReader::put_lens(LookEntry& entry, const std::function<bool(std::string_view row)>& is_written) const {
    const ParamTable& rows = entry.effect->parameters;
    if (rows.find("focus_distance") == nullptr) return;
    for (const LensKey& key : lens_keys) {
        const std::optional<float>& value = lens_.*key.member;
        const ParamInfo* const row = rows.find(key.row);
        if (!value || row == nullptr || row->kind != Kind::Float || is_written(key.row)) continue;
        const auto word = std::bit_cast<std::uint32_t>(*value);
        if (check_words(*row, {&word, 1})) entry.words[row->word] = word;
    }
}

bool LookReader::take(const ParamInfo& row, std::span<std::uint32_t> words, const toml::node& node,
                      std::string_view key) {
    const Result<std::optional<ParamValue>> read = value_for(row, node);
    if (!read) {
        report(node, Weight::Wrong, fmt::format("{} = {}: {}", key, show(node), read.error().text));
        return false;
    }
    const std::optional<ParamValue>& value = *read;
    if (!value) {
        report(node, Weight::Wrong,
               fmt::format("{} = {}: expected {}, allowed is {}", key, show(node), expected_kind(row.kind),
                           interval(row)));
        return false;
    }
    const std::optional<ParamProblem> problem = try_assign(row, words, *value, key);
    if (!problem) return true;
    // Of a variable with a name of its own a menu or a console would not take the value, either.
    const bool is_wrong = problem->why == ParamProblem::Why::WrongKind || !row.also.empty();
    const std::string used = is_wrong || options_.is_strict ? "" : fmt::format("; {} is used", format(row, words));
    report(node, is_wrong ? Weight::Wrong : Weight::Slip, problem->text + used);
    return false;
}

bool LookReader::take(const ParamInfo& row, LookEntry& entry, const toml::node& node, std::string_view key) {
    if (row.kind != Kind::Resource) return take(row, entry.words, node, key);
    const auto* const name = node.as_string();
    const std::string wrong = name == nullptr ? fmt::format("expected {}", interval(row)) : [&] {
        const Result<> done = files_.put(entry, row, name->get());
        return done ? std::string() : done.error().text;
    }();
    if (!wrong.empty()) report(node, Weight::Wrong, fmt::format("{} = {}: {}", key, show(node), wrong));
    return wrong.empty();
}

void LookReader::take(const WireInfo& wire, LookEntry& entry, const std::string& file, const toml::node& node) {
    if (const Result<> done = files_.put(entry, wire, file); !done)
        report(node, Weight::Wrong, fmt::format("{} = {}: {}", wire.key, show(node), done.error().text));
}

bool LookReader::take(const ParamInfo& row, EntryState& state, const toml::node& node, std::string_view key) {
    StateWords words = state_words(state);
    const bool is_taken = take(row, words, node, key);
    state = std::bit_cast<EntryState>(words);
    return is_taken;
}

void LookReader::report_unknown(const toml::key& key, const toml::node& node, std::span<const std::string> known,
                                const std::function<std::string(const std::string&)>& allowed,
                                const std::string& meant) {
    std::string text = fmt::format("unknown key '{}' = {}", printable(key.str()), show(node));
    // Looking for names is slow, and no more problems than these are shown.
    const bool is_sought = meant.empty() && problems_.size() < max_suggestions;
    const std::string near = is_sought ? nearest(key.str(), known) : meant;
    if (!near.empty()) text += fmt::format(", did you mean '{}', which takes {}?", near, allowed(near));
    report(key.source().begin, Weight::Slip, std::move(text));
}

// Errors end the reading all together, in the order of the file; the rest goes to the caller's list.
Result<Look> LookReader::finish(Look look) {
    look.shown_name = shown_name_;
    std::stable_sort(problems_.begin(), problems_.end(),
                     [](const Problem& a, const Problem& b) { return a.place < b.place; });
    constexpr std::size_t most = 20;
    std::vector<std::string> errors, warnings;
    for (const Problem& problem : problems_) {
        const bool is_error = problem.weight == Weight::Wrong || (problem.weight == Weight::Slip && options_.is_strict);
        (is_error ? errors : warnings)
            .push_back(
                fmt::format("{}:{}:{}: {}", shown_name_, problem.place.line, problem.place.column, problem.text));
    }
    for (std::vector<std::string>* const list : {&errors, &warnings}) {
        if (list->size() <= most) continue;
        const std::size_t more = list->size() - most;
        list->resize(most);
        list->push_back(fmt::format("{}: and {} more like these", shown_name_, more));
    }
    if (options_.warnings != nullptr)
        options_.warnings->insert(options_.warnings->end(), warnings.begin(), warnings.end());
    if (!errors.empty()) return user_error(fmt::format("{}", fmt::join(errors, "; ")));
    return look;
}

namespace {

Result<Look> parse(std::string_view text, const std::string& shown_name, const LookOptions& options,
                   const CameraLens& lens) {
    std::string shown = printable(shown_name);
    DARKROOM_TRY_VALUE(const toml::table file, parse_toml(text, shown));
    return LookReader(std::move(shown), options, lens).read(file);
}

}  // namespace

Result<Look> parse_look(std::string_view text, std::string shown_name, const LookOptions& options,
                        const CameraLens& lens) try {
    return parse(text, shown_name, options, lens);
} catch (...) {
    return caught("parse_look");
}

Result<Look> parse_look(std::string_view text, std::string shown_name, const LookOptions& options) {
    return parse_look(text, std::move(shown_name), options, {});
}

Result<std::string> read_look_text(const std::filesystem::path& path) {
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes, read_file(path, {.max_size = max_toml_bytes}));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

Result<Look> read_look(const std::filesystem::path& path, const LookOptions& options, const CameraLens& lens) try {
    DARKROOM_TRY_VALUE(const std::string text, read_look_text(path));
    LookOptions here = options;
    if (here.folder.empty()) here.folder = path.parent_path();
    return parse(text, path.string(), here, lens);
} catch (...) {
    return caught("read_look");
}

Result<Look> read_look(const std::filesystem::path& path, const LookOptions& options) {
    return read_look(path, options, {});
}

}  // namespace darkroom
