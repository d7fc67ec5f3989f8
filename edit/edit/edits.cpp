// SPDX-License-Identifier: MIT
#include "edit/edits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/text/param_text.hpp"
#include "edit/splice/restructure.hpp"
#include "looks/apply/look_resources.hpp"

namespace darkroom::edit {

namespace {

using Words = std::span<const std::uint32_t>;

/// The entry of this name, whose value will be set: one of the interface is there with the whole of it.
Result<LookTarget> target_of(Look& look, std::string_view entry, std::string_view member) {
    if (const LookEntry* const found = find_entry(look, entry); found != nullptr && found->is_of_ui && !look.ui)
        add_ui(look);
    const std::string key = fmt::format("{}.{}", entry, member);
    return find_target(look, key, printable(key));
}

Result<> set_words(Look& look, LookTarget target, Words words, const std::string& shown) {
    const ParamInfo& row = *target.row;
    LookEntry& entry = *target.entry;
    if (row.kind == Kind::Resource) return user_error(fmt::format("{}: takes the name of a file", shown));
    DARKROOM_TRY(check_words(row, words, shown));
    std::ranges::copy(words, entry.words.begin() + row.word);
    if (const std::string conflict = conflict_of(entry); !conflict.empty()) return user_error(conflict);
    if (row.is_amount && look.is_flat && !entry.is_of_ui) entry.state.enabled = std::bit_cast<float>(words[0]) != 0;
    return {};
}

}  // namespace

Result<> set_value(Look& look, std::string_view entry, std::string_view parameter, Words words) {
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, parameter));
    const std::string shown = fmt::format("{}.{}", printable(entry), printable(parameter));
    if (target.row == nullptr || target.is_state)
        return user_error(fmt::format("{}: the effect has no such parameter", shown));
    return set_words(look, target, words, shown);
}

Result<> reset_value(Look& look, std::string_view entry, std::string_view parameter) {
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, parameter));
    if (target.row == nullptr || target.is_state)
        return user_error(
            fmt::format("{}.{}: the effect has no such parameter", printable(entry), printable(parameter)));
    const ParamInfo& row = *target.row;
    if (row.kind == Kind::Resource) return set_file(look, entry, parameter, {}, {});
    return set_value(look, entry, parameter, target.entry->effect->parameters.defaults.subspan(row.word, row.words));
}

Result<> reset_entry(Look& look, std::string_view entry) {
    DARKROOM_TRY_VALUE(LookEntry* const found, entry_at(look, entry));
    const std::span<const std::uint32_t> defaults = found->effect->parameters.defaults;
    found->words.assign(defaults.begin(), defaults.end());
    std::erase_if(found->resources,
                  [&](const LookResource& one) { return found->effect->parameters.find(one.parameter) != nullptr; });
    return {};
}

Result<> set_state(Look& look, std::string_view entry, std::string_view row, Words words) {
    if (row != "enabled") DARKROOM_TRY(restructured(look, entry));
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, row));
    const std::string shown = fmt::format("{}.{}", printable(entry), printable(row));
    if (!target.is_state) return user_error(fmt::format("{}: an entry has no such key", shown));
    DARKROOM_TRY(check_words(*target.row, words, shown));
    StateWords state = state_words(target.entry->state);
    std::ranges::copy(words, state.begin() + target.row->word);
    target.entry->state = std::bit_cast<EntryState>(state);
    return {};
}

Result<> set_wire(Look& look, std::string_view entry, std::string_view wire, const std::string& name,
                  const LookOptions& options) {
    DARKROOM_TRY_VALUE(LookEntry* const found, restructured(look, entry));
    const auto* const end = std::ranges::find(wires, wire, &WireInfo::key);
    const std::string shown = fmt::format("{}.{} = \"{}\"", printable(entry), printable(wire), printable(name));
    if (end == wires.end())
        return user_error(fmt::format("{}: allowed are name, input, source, second, mask, output", shown));
    std::string_view text = name;
    if (end->is_reference && is_file_name(text)) return ResourceFiles(options.folder, options).put(*found, *end, name);
    if (end->is_reference && text.ends_with(previous_suffix)) text.remove_suffix(previous_suffix.size());
    if (!text.empty() && !is_look_name(text))
        return user_error(fmt::format("{}: expected a name of letters, digits, '_' and '-'", shown));
    if (end->is_reference) return ResourceFiles(options.folder, options).put(*found, *end, name);
    (found)->*end->member = name;
    return {};
}

Result<> set_file(Look& look, std::string_view entry, std::string_view parameter, const std::string& file,
                  const LookOptions& options) {
    DARKROOM_TRY_VALUE(const LookTarget target, target_of(look, entry, parameter));
    const std::string shown = fmt::format("{}.{}", printable(entry), printable(parameter));
    if (target.row == nullptr || target.is_state || target.row->kind != Kind::Resource)
        return user_error(fmt::format("{}: takes no file", shown));
    Result<> done = ResourceFiles(options.folder, options).put(*target.entry, *target.row, file);
    if (!done) return user_error(fmt::format("{}: {}", shown, done.error().text));
    if (target.row->is_amount && look.is_flat && !target.entry->is_of_ui) target.entry->state.enabled = !file.empty();
    return {};
}

void take_look(Look& look, Look other, const std::filesystem::path& from, const std::filesystem::path& to) {
    const auto rename = [&](std::string& file) {
        if (file.empty() || std::filesystem::path(file).is_absolute()) return;
        std::error_code error;
        const std::filesystem::path named = std::filesystem::proximate(from / file, to.empty() ? "." : to, error);
        file = (error ? from / file : named).generic_string();
    };
    const std::vector<std::string> names = entry_names(look), other_names = entry_names(other);
    for (std::size_t i = 0; i < other.entries.size(); ++i) {
        LookEntry& entry = other.entries[i];
        for (LookResource& resource : entry.resources) {
            for (std::string* const wire : {&entry.input, &entry.source, &entry.second, &entry.mask})
                if (*wire == resource.file) rename(*wire);
            rename(resource.file);
        }
        rename(entry.effect_file);
        const auto same = std::ranges::find(names, other_names[i]);
        entry.id = same == names.end() ? 0 : look.entries[static_cast<std::size_t>(same - names.begin())].id;
    }
    for (LookLayer& layer : other.layers) rename(layer.file);
    if (other.ui) {
        rename(other.ui->document);
        for (std::string& script : other.ui->controllers) rename(script);
    }
    other.shown_name = look.shown_name;
    look = std::move(other);
}

}  // namespace darkroom::edit
