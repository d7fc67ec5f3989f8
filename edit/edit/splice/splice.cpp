// SPDX-License-Identifier: MIT
#include "edit/splice/splice.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "edit/follow/compare.hpp"
#include "edit/splice/list_blocks.hpp"
#include "edit/splice/splice_movers.hpp"
#include "edit/splice/toml_editor.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/apply/look_stack.hpp"
#include "looks/look_parts.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::edit {

namespace {

const TomlPath flat_path{"post_process"}, ui_path{"ui"};

const std::vector<std::string> interface_keys{"document", "controllers", "game"};

/// Does an element of the file that has this row say it as before? What a size is measured in stands beside its number.
bool is_said_alike(const LookEntry& before, const LookEntry& now, const ParamInfo& row) {
    return has_same(before, now, row) &&
           (row.reach_word == ~0u || before.words[row.reach_word] == now.words[row.reach_word]);
}

/// Is this what sizes of the effect are measured in, which their "%" says?
bool is_reach(const EffectInfo& effect, const ParamInfo& row) {
    return std::ranges::find(effect.parameters.rows, row.word, &ParamInfo::reach_word) != effect.parameters.rows.end();
}

std::string bool_text(Toggle toggle) { return toggle.on != 0 ? "true" : "false"; }

class Splicer {
  public:
    Splicer(TomlEditor editor, const Look& was, const Look& is, const CameraLens& lens)
        : editor_(std::move(editor)), was_(was), is_(is), lens_(lens) {}

    Result<std::string> run() {
        for (const auto step : {&Splicer::write_picture, &Splicer::write_ui}) DARKROOM_TRY((this->*step)());
        DARKROOM_TRY(splice_movers(editor_, was_, is_));
        return editor_.text();
    }

  private:
    Result<> write_picture() {
        if (is_.is_flat) {
            if (!was_.is_flat) DARKROOM_TRY(editor_.remove_table({"stack"}));
            return write_flat();
        }
        return was_.is_flat ? make_stack() : write_stack();
    }

    Result<> write_ui() {
        if (!is_.ui) {
            if (!was_.ui) return {};
            const auto removed = editor_.remove_table(ui_path);
            return removed ? Result<>{} : failure(removed.error());
        }
        if (!editor_.contains(ui_path)) DARKROOM_TRY(editor_.add_table(ui_path[0]));
        DARKROOM_TRY(write_interface(was_.ui.value_or(LookUi{}), *is_.ui));
        return write_table(ui_path, true);
    }

    /// Sets a key, or takes it out where there is no value.
    Result<> write_text(const TomlPath& table, std::string_view key, const std::string& value) {
        return value.empty() ? editor_.remove(table, key) : editor_.set(table, key, value, interface_keys);
    }

    Result<> write_interface(const LookUi& before, const LookUi& now) {
        const auto text = [](const std::string& name) { return name.empty() ? name : toml_string(name); };
        if (now.document != before.document) DARKROOM_TRY(write_text(ui_path, "document", text(now.document)));
        if (now.controllers != before.controllers)
            DARKROOM_TRY(write_text(ui_path, "controllers", list_text(now.controllers)));
        if (now.game == before.game) return {};
        const TomlPath game{ui_path[0], "game"};
        const bool is_inline = editor_.find(game) != nullptr;
        if (!editor_.contains(game) || (is_inline && now.game.empty()))
            return write_text(ui_path, "game", game_text(now.game));
        for (const auto& [name, value] : before.game)
            if (!now.game.contains(name)) DARKROOM_TRY(editor_.remove(game, name));
        for (const auto& [name, value] : now.game) {
            const auto old = before.game.find(name);
            if (old != before.game.end() && old->second == value) continue;
            DARKROOM_TRY(editor_.set(game, name, game_text(value)));
        }
        return {};
    }

    // The flat tables.

    Result<> write_flat() {
        if (is_.is_enabled != (!was_.is_flat || was_.is_enabled))
            DARKROOM_TRY(editor_.set(flat_path, "enabled", bool_text(is_.is_enabled)));
        const auto write_order = [&] {
            return editor_.set(flat_path, "order", toml_string(order_names[static_cast<std::size_t>(is_.order)]));
        };
        if (was_.is_flat && is_.order != was_.order) DARKROOM_TRY(write_order());
        DARKROOM_TRY(write_table(flat_path, false));
        // A table that names no order is in the documented one, a look without a table in the other.
        const bool has_table = editor_.contains(flat_path), is_documented = is_.order == LookOrder::Documented;
        const bool must_say = is_documented ? !was_.is_flat && !has_table : has_table;
        return must_say && !has_key(flat_path, "order") ? write_order() : Result<>{};
    }

    Result<> write_table(const TomlPath& table, bool is_of_ui) {
        const auto counterpart = [&](const LookEntry& entry, const Look& in) -> const LookEntry* {
            const auto found = std::ranges::find_if(in.entries, [&](const LookEntry& other) {
                return other.effect->name == entry.effect->name && other.is_of_ui == is_of_ui;
            });
            return found == in.entries.end() || !was_has(table) ? nullptr : &*found;
        };
        for (const LookEntry& entry : is_.entries) {
            if (entry.is_of_ui != is_of_ui) continue;
            DARKROOM_TRY(write_flat_entry(table, counterpart(entry, was_), entry));
        }
        // What was off when a flat table became a stack is not in it.
        for (const LookEntry& before : was_.entries) {
            if (before.is_of_ui != is_of_ui || !was_has(table) || counterpart(before, is_) != nullptr) continue;
            LookEntry off = before;
            off.state.enabled = false;
            DARKROOM_TRY(write_flat_entry(table, &before, off));
        }
        return {};
    }

    /// `before` null: it was not there, so that nobody knows what the table says of it.
    Result<> write_flat_entry(const TomlPath& table, const LookEntry* before, const LookEntry& entry) {
        const std::string_view effect = entry.effect->name;
        const LookEntry plain = flat_entry(*entry.effect, is_.order);
        const bool is_on = entry.state.enabled.on != 0;
        // What the table does not say follows from its order.
        const bool is_switched =
            before == nullptr || is_.order != was_.order || is_on != (before->state.enabled.on != 0);
        const auto is_row_said = [&](const ParamInfo& row) {
            return has_key(table, flat_key(effect, row.name)) ||
                   (!row.formerly.empty() && has_key(table, flat_key(effect, row.formerly)));
        };
        const auto is_same_row = [&](const ParamInfo& row) {
            const bool is_said = is_row_said(row), is_of_camera = is_said_by_camera(entry, row);
            if (!is_said && is_of_camera && before == nullptr) return false;
            const bool is_known = is_said || is_of_camera || is_reach(*entry.effect, row);
            const LookEntry& other = before != nullptr && is_known ? *before : plain;
            return is_said ? is_said_alike(other, entry, row) : has_same(other, entry, row);
        };
        if (!is_switched && std::ranges::all_of(entry.effect->parameters.rows, is_same_row)) return {};
        const std::string switch_key = flat_key(effect, "enabled");
        std::vector<std::string> own{switch_key};
        for (const ParamInfo& row : entry.effect->parameters.rows) own.push_back(flat_key(effect, row.name));
        bool is_amount_new = false;
        for (const ParamInfo& row : entry.effect->parameters.rows) {
            const std::string key = flat_key(effect, row.name);
            const std::string former = row.formerly.empty() ? key : flat_key(effect, row.formerly);
            const bool may_stand = before == nullptr && (has_key(table, key) || has_key(table, former));
            if (is_same_row(row) && !may_stand) continue;
            is_amount_new |= row.is_amount;
            DARKROOM_TRY(set_row(table, key, former, value_text(entry, row), own));
        }
        const bool is_said = has_key(table, switch_key);
        const bool is_other =
            is_said ? is_switched : (is_switched || is_amount_new) && is_on != is_on_unsaid(table, entry);
        return is_other ? editor_.set(table, switch_key, bool_text(entry.state.enabled), own) : Result<>{};
    }

    /// Was the table there before?
    bool was_has(const TomlPath& table) const { return table == ui_path ? was_.ui.has_value() : was_.is_flat; }

    /// Is an entry on where the table says nothing of its switch? Of its amounts the last one of the table's counts,
    /// in the order of the keys.
    bool is_on_unsaid(const TomlPath& table, const LookEntry& entry) const {
        if (entry.is_of_ui) return true;
        bool out = flat_entry(*entry.effect, is_.order).state.enabled.on != 0;
        std::string last;
        for (const ParamInfo& row : entry.effect->parameters.rows)
            for (const std::string_view name : {row.name, row.formerly}) {
                const std::string key = name.empty() ? std::string() : flat_key(entry.effect->name, name);
                if (!row.is_amount || key <= last || !has_key(table, key)) continue;
                last = key;
                out = std::bit_cast<float>(entry.words[row.word]) != 0;
            }
        return out;
    }

    /// A key's former name stays where it stands.
    Result<> set_row(const TomlPath& table, const std::string& key, const std::string& former, const std::string& text,
                     std::span<const std::string> neighbours) {
        const bool has_former = former != key && has_key(table, former);
        if (has_former) DARKROOM_TRY(editor_.set(table, former, text));
        return has_former && !has_key(table, key) ? Result<>{} : editor_.set(table, key, text, neighbours);
    }

    bool has_key(TomlPath table, std::string_view key) const {
        table.emplace_back(key);
        return editor_.contains(table);
    }

    // The stack.

    static std::vector<const LookEntry*> stacked(const Look& look) {
        std::vector<const LookEntry*> out;
        for (const LookEntry& entry : look.entries)
            if (!entry.is_of_ui) out.push_back(&entry);
        return out;
    }

    Result<> make_stack() {
        DARKROOM_TRY_VALUE(const auto place, editor_.remove_table(flat_path));
        std::vector<ListElement> elements;
        for (const LookEntry* const entry : stacked(is_)) elements.push_back({std::nullopt, pairs_of(*entry)});
        if (elements.empty()) return editor_.set({}, "stack", "[]");
        const std::string eol(editor_.line_end()), &text = editor_.text();
        std::string blocks = blocks_of("stack", elements, eol);
        if (place < text.size())
            blocks += text[place] == '\n' || text[place] == '\r' ? std::string() : eol;
        else if (!text.empty())
            blocks = (text.ends_with('\n') ? eol : eol + eol) + blocks;
        return editor_.replace(place, place, blocks);
    }

    Result<> write_stack() {
        const std::vector<const LookEntry*> before = stacked(was_), now = stacked(is_);
        if (list_size(editor_, "stack") != before.size())
            return user_error(fmt::format("the text has {} entries in its stack, where {} were read",
                                          list_size(editor_, "stack"), before.size()));
        const std::vector<const LookEntry*> others = counterparts(is_, was_);
        std::vector<ListElement> elements;
        bool is_arranged = now.size() == before.size();
        for (const LookEntry* const entry : now) {
            const LookEntry* const other = others[static_cast<std::size_t>(entry - is_.entries.data())];
            if (other == nullptr) {
                elements.push_back({std::nullopt, pairs_of(*entry)});
                is_arranged = false;
                continue;
            }
            const auto number = static_cast<std::size_t>(std::ranges::find(before, other) - before.begin());
            is_arranged &= number == elements.size();
            elements.push_back({number, {}});
            DARKROOM_TRY(write_entry({"stack", std::to_string(number)}, *other, *entry));
        }
        if (is_arranged) return {};
        if (!elements.empty()) return arrange_list(editor_, "stack", elements);
        // Without the list, the text would be that of a flat look.
        DARKROOM_TRY(editor_.remove_table({"stack"}));
        return editor_.set({}, "stack", "[]");
    }

    Result<> write_entry(const TomlPath& table, const LookEntry& before, const LookEntry& entry) {
        if (entry.effect_file != before.effect_file)
            DARKROOM_TRY(editor_.set(table, "effect", toml_string(entry.effect_file)));
        for (const WireInfo& wire : wires) {
            const std::string& name = entry.*wire.member;
            if (name == before.*wire.member) continue;
            DARKROOM_TRY(name.empty() ? editor_.remove(table, wire.key)
                                      : editor_.set(table, wire.key, toml_string(name)));
        }
        const StateWords state = state_words(entry.state), state_before = state_words(before.state);
        for (const ParamInfo& row : entry_rows.rows) {
            const std::string text = format(row, state);
            if (text == format(row, state_before)) continue;
            DARKROOM_TRY(editor_.set(table, row.name, text));
        }
        for (const ParamInfo& row : entry.effect->parameters.rows) {
            const std::string key(row.name), former(row.formerly.empty() ? row.name : row.formerly);
            const bool is_said = has_key(table, key) || has_key(table, former);
            if (is_said ? is_said_alike(before, entry, row) : has_same(before, entry, row)) continue;
            DARKROOM_TRY(set_row(table, key, former, value_text(entry, row), {}));
        }
        return {};
    }

    /// Does a camera say it where the look does not?
    bool is_said_by_camera(const LookEntry& entry, const ParamInfo& row) const {
        return entry.effect->parameters.find("focus_distance") != nullptr &&
               std::ranges::any_of(lens_keys, [&](const LensKey& key) {
                   return key.row == row.name &&
                          (lens_.*key.member || editor_.contains({"camera", std::string(key.key)}));
               });
    }

    /// What a new entry has to say.
    std::vector<std::string> pairs_of(const LookEntry& entry) const {
        std::vector<std::string> out;
        const auto say = [&](std::string_view key, std::string_view value) {
            out.push_back(fmt::format("{} = {}", key, value));
        };
        say("effect", toml_string(entry.effect_file.empty() ? entry.effect->name : entry.effect_file));
        for (const WireInfo& wire : wires)
            if (!(entry.*wire.member).empty()) say(wire.key, toml_string(entry.*wire.member));
        const LookEntry plain = entry_of(*entry.effect);
        const StateWords state = state_words(entry.state), state_plain = state_words(plain.state);
        for (const ParamInfo& row : entry_rows.rows)
            if (const std::string text = format(row, state); text != format(row, state_plain)) say(row.name, text);
        for (const ParamInfo& row : entry.effect->parameters.rows)
            if (!has_same(plain, entry, row) || is_said_by_camera(entry, row)) say(row.name, value_text(entry, row));
        return out;
    }

    TomlEditor editor_;
    const Look& was_;
    const Look& is_;
    const CameraLens& lens_;
};

}  // namespace

Result<std::string> splice_look(std::string_view text, const Look& was, const Look& is, const CameraLens& lens) {
    DARKROOM_TRY(parse_toml(text, was.shown_name));
    DARKROOM_TRY_VALUE(TomlEditor editor, TomlEditor::of(std::string(text)));
    Result<std::string> out = Splicer(std::move(editor), was, is, lens).run();
    if (!out) return failure(Error{out.error().fault, fmt::format("{}: {}", is.shown_name, out.error().text)});
    return out;
}

}  // namespace darkroom::edit
