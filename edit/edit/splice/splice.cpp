// SPDX-License-Identifier: MIT
#include "edit/splice/splice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <darkroom/look.hpp>
#include <tuple>

#include "core/text/param_text.hpp"
#include "edit/follow/compare.hpp"
#include "edit/follow/moved_values.hpp"
#include "edit/splice/list_blocks.hpp"
#include "edit/splice/toml_editor.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/apply/look_stack.hpp"
#include "looks/look_parts.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::edit {

namespace {

// Pulses and layers of a look that was edited, in the text that it was read from.

/// Are both the same one, of whatever values?
bool is_counterpart(const LookPulse& a, const LookPulse& b) {
    return a.event == b.event && a.entry == b.entry && a.parameter == b.parameter;
}
bool is_counterpart(const LookLayer& a, const LookLayer& b) {
    return a.name == b.name && a.file == b.file && a.distance.has_value() == b.distance.has_value();
}

bool is_same_value(const MovedValue& a, const MovedValue& b) {
    return a.table == b.table && a.entry == b.entry && a.row.name == b.row.name;
}

std::string pair_of(std::string_view key, std::string_view value) { return fmt::format("{} = {}", key, value); }

class MoverSplicer {
  public:
    MoverSplicer(TomlEditor& editor, const Look& was, const Look& is) : editor_(editor), was_(was), is_(is) {}

    Result<> run() {
        Result<> done = write(false, was_.pulses, is_.pulses);
        return done ? write(true, was_.layers, is_.layers) : done;
    }

  private:
    /// Which of the former ones each is now. Those of the same values come first: of two pulses that differ in them
    /// alone, the one that went takes its own text along.
    template <class Movers>
    [[nodiscard]] std::vector<std::optional<std::size_t>> counterparts_of(bool is_layer, const Movers& before,
                                                                          const Movers& now) const {
        std::vector<std::optional<std::size_t>> out(now.size());
        std::vector<bool> is_taken(before.size());
        const auto has_same_values = [&](std::size_t a, std::size_t b) {
            return std::ranges::equal(
                values_of(was_, {is_layer, a}), values_of(is_, {is_layer, b}),
                [](const MovedValue& x, const MovedValue& y) { return is_same_value(x, y) && x.words == y.words; });
        };
        for (const bool is_first : {true, false})
            for (std::size_t i = 0; i < now.size(); ++i)
                for (std::size_t k = 0; k < before.size() && !out[i]; ++k) {
                    if (is_taken[k] || !is_counterpart(before[k], now[i]) || (is_first && !has_same_values(k, i)))
                        continue;
                    out[i] = k;
                    is_taken[k] = true;
                }
        return out;
    }

    template <class Movers>
    Result<> write(bool is_layer, const Movers& before, const Movers& now) {
        const std::string key = is_layer ? "layer" : "pulse";
        const std::size_t size = list_size(editor_, key);
        // Pulses of the text are all in the look; a layer that changes nothing is not.
        if (before.empty() && now.empty()) return {};
        if (!is_layer && size != before.size())
            return user_error(fmt::format("the text has {} pulses, where {} were read", size, before.size()));
        std::vector<ListElement> elements;
        std::vector<bool> is_known(size);
        for (const auto& one : before)
            if (const auto place = place_in_text(one, before)) is_known[*place] = true;
        const auto counterparts = counterparts_of(is_layer, before, now);
        for (std::size_t i = 0; i < now.size(); ++i) {
            const Mover mover{is_layer, i};
            const auto place =
                counterparts[i] ? place_in_text(before[*counterparts[i]], before) : std::optional<std::size_t>();
            if (!place) {
                elements.push_back({std::nullopt, pairs_of(mover)});
                continue;
            }
            elements.push_back({*place, {}});
            DARKROOM_TRY(write_values({key, std::to_string(*place)}, {is_layer, *counterparts[i]}, mover));
        }
        // What is in no look stays behind what it stood behind.
        for (std::size_t k = 0; k < size; ++k) {
            if (is_known[k]) continue;
            const auto behind = std::ranges::find_if(
                elements, [&](const ListElement& one) { return k > 0 && one.now == std::optional(k - 1); });
            elements.insert(behind == elements.end() ? elements.begin() : behind + 1, ListElement{k, {}});
        }
        bool is_arranged = elements.size() == size;
        for (std::size_t i = 0; i < elements.size(); ++i) is_arranged &= elements[i].now == std::optional(i);
        return is_arranged ? Result<>{} : arrange_list(editor_, key, elements);
    }

    static std::optional<std::size_t> place_in_text(const LookPulse& pulse, const std::vector<LookPulse>& all) {
        return static_cast<std::size_t>(&pulse - all.data());
    }
    [[nodiscard]] std::optional<std::size_t> place_in_text(const LookLayer& layer,
                                                           const std::vector<LookLayer>&) const {
        for (std::size_t i = 0;; ++i) {
            const TomlItem* const item = editor_.find({"layer", std::to_string(i), "name"});
            if (item == nullptr) return std::nullopt;
            const std::string value = editor_.text().substr(item->value_begin, item->end - item->value_begin);
            const toml::parse_result read = toml::parse("name = " + value);
            if (read && read.table()["name"].value_or(std::string_view()) == layer.name) return i;
        }
    }

    Result<> write_values(const TomlPath& table, Mover before, Mover now) {
        const std::vector<MovedValue> values_before = values_of(was_, before), values_now = values_of(is_, now);
        const auto find = [](const std::vector<MovedValue>& in, const MovedValue& value) {
            return std::ranges::find_if(in, [&](const MovedValue& other) { return is_same_value(value, other); });
        };
        for (const MovedValue& value : values_now) {
            const auto other = find(values_before, value);
            if (other != values_before.end() && other->words == value.words) continue;
            const auto [place, key] = place_of(table, value);
            DARKROOM_TRY(editor_.set(place, key, format(value.row, value.words)));
        }
        for (const MovedValue& value : values_before) {
            if (find(values_now, value) != values_now.end()) continue;
            const auto [place, key] = place_of(table, value);
            DARKROOM_TRY(editor_.remove(place, key));
        }
        return {};
    }

    /// The table and the key of a value. A layer's may be written as "bloom.intensity", bloom_intensity or with a table
    /// for the entry.
    [[nodiscard]] std::pair<TomlPath, std::string> place_of(TomlPath table, const MovedValue& value) const {
        if (!value.table.empty()) table.push_back(value.table);
        if (value.entry.empty()) return {table, std::string(value.row.name)};
        const std::string_view effect = std::string_view(value.entry).substr(0, value.entry.find('#'));
        for (const std::string_view name : {value.row.name, value.row.formerly}) {
            if (name.empty()) continue;
            const std::string dotted = fmt::format("{}.{}", value.entry, name), flat = flat_key(effect, name);
            for (const std::string& key : {dotted, flat})
                if (has_key(table, key)) return {table, key};
            TomlPath nested = table;
            nested.push_back(value.entry);
            if (has_key(nested, name)) return {nested, std::string(name)};
        }
        return {table, fmt::format("{}.{}", value.entry, value.row.name)};
    }

    [[nodiscard]] bool has_key(TomlPath table, std::string_view key) const {
        table.emplace_back(key);
        return editor_.contains(table);
    }

    /// What a new one has to say.
    [[nodiscard]] std::vector<std::string> pairs_of(Mover mover) const {
        std::vector<std::string> out, distance, values;
        if (mover.is_layer) {
            const LookLayer& layer = is_.layers[mover.number];
            out.push_back(pair_of("name", toml_string(layer.name)));
            if (!layer.file.empty()) out.push_back(pair_of("look", toml_string(layer.file)));
        } else {
            const LookPulse& pulse = is_.pulses[mover.number];
            out.push_back(pair_of("event", toml_string(pulse.event)));
            out.push_back(pair_of("parameter", toml_string(fmt::format("{}.{}", pulse.entry, pulse.parameter))));
        }
        for (const MovedValue& value : values_of(is_, mover)) {
            const std::string text = format(value.row, value.words);
            if (value.table == "values")
                values.push_back(pair_of(toml_string(fmt::format("{}.{}", value.entry, value.row.name)), text));
            else if (value.table == "distance")
                distance.push_back(pair_of(value.row.name, text));
            else
                out.push_back(pair_of(value.row.name, text));
        }
        if (!distance.empty()) out.push_back(fmt::format("distance = {{ {} }}", fmt::join(distance, ", ")));
        if (!values.empty()) out.push_back(fmt::format("values = {{ {} }}", fmt::join(values, ", ")));
        return out;
    }

    TomlEditor& editor_;
    const Look& was_;
    const Look& is_;
};

/// As splice_look, for [[pulse]] and [[layer]] alone.
Result<> splice_movers(TomlEditor& editor, const Look& was, const Look& is) {
    return MoverSplicer(editor, was, is).run();
}

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
