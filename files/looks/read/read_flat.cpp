// SPDX-License-Identifier: MIT
// The flat table [post_process]: one key for each parameter of each effect that has a place in it. And the table [ui],
// which is the same for the effects of the interface.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/read/look_reader.hpp"

namespace darkroom {

namespace {

const ParamInfo enabled_row{.name = "enabled", .kind = Kind::Toggle};
const ParamInfo order_row{.name = "order", .kind = Kind::Choice, .choices = order_names};

class FlatReader {
  public:
    FlatReader(LookReader& reader, Look& look, bool is_of_ui) : reader_(reader), look_(look), is_of_ui_(is_of_ui) {
        for (LookEntry& entry : look_.entries)
            if (entry.is_of_ui == is_of_ui) add_keys(entry);
        for (LookEntry& entry : look_.entries)
            if (entry.is_of_ui == is_of_ui) add_former_keys(entry);
    }

    void read(const toml::table& table) {
        for (const auto& [key, node] : table) read_value(key, node);
        // Toggles come last: what they say counts, whatever an amount implies.
        for (const auto& [key, node] : table) {
            const auto found = targets_.find(key.str());
            if (found != targets_.end() && found->second.row == &enabled_row)
                read_toggle(*found->second.entry, node, key.str());
        }
        for (const LookEntry& entry : look_.entries)
            if (const std::string conflict = conflict_of(entry); !conflict.empty())
                reader_.report(table, Weight::Wrong, conflict);
    }

  private:
    struct Target {
        LookEntry* entry = nullptr;
        const ParamInfo* row = nullptr;
    };

    void add_keys(LookEntry& entry) {
        const EffectInfo& effect = *entry.effect;
        targets_[flat_key(effect.name, "enabled")] = {&entry, &enabled_row};
        for (const ParamInfo& row : effect.parameters.rows) targets_[flat_key(effect.name, row.name)] = {&entry, &row};
        for (const auto& [key, target] : targets_)
            if (target.entry == &entry) names_.push_back(key);
    }

    // Former names are read, but nobody is pointed to them.
    void add_former_keys(LookEntry& entry) {
        const EffectInfo& effect = *entry.effect;
        for (const ParamInfo& row : effect.parameters.rows)
            if (!row.formerly.empty()) targets_.try_emplace(flat_key(effect.name, row.formerly), Target{&entry, &row});
    }

    std::string allowed(const std::string& key) const {
        const auto found = targets_.find(key);
        if (found != targets_.end()) return interval(*found->second.row);
        return interval(key == "order" ? order_row : enabled_row);
    }

    void read_value(const toml::key& key, const toml::node& node) {
        if (is_of_ui_ && key.str() == "document") return read_document(node);
        if (is_of_ui_ && key.str() == "controllers") return read_controllers(node);
        if (is_of_ui_ && key.str() == "game") return read_game(node);
        if (!is_of_ui_ && key.str() == "enabled") return read_enabled(node);
        if (!is_of_ui_ && key.str() == "order") return read_order(node);
        const auto found = targets_.find(key.str());
        if (found == targets_.end()) return read_unknown(key, node);
        const auto& [entry, row] = found->second;
        if (!is_of_ui_) {
            const toml::source_position at = key.source().begin;
            look_.written.push_back({entry->effect, row->name, fmt::format("{}:{}", at.line, at.column)});
        }
        if (row == &enabled_row) return;
        if (!reader_.take(*row, *entry, node, key.str()) || !row->is_amount || is_of_ui_) return;
        entry->state.enabled = std::bit_cast<float>(entry->words[row->word]) != 0;
        entry->is_asked_for = entry->state.enabled.on != 0;
    }

    void read_toggle(LookEntry& entry, const toml::node& node, std::string_view key) {
        if (reader_.take(entry_rows.rows[0], entry.state, node, key)) entry.is_asked_for = entry.state.enabled.on != 0;
    }

    void read_enabled(const toml::node& node) {
        std::array<std::uint32_t, 1> words{1};
        reader_.take(enabled_row, words, node, "enabled");
        look_.is_enabled = words[0] != 0;
    }

    void read_order(const toml::node& node) {
        std::array<std::uint32_t, 1> words{static_cast<std::uint32_t>(look_.order)};
        reader_.take(order_row, words, node, "order");
        look_.order = static_cast<LookOrder>(words[0]);
    }

    std::optional<std::string> file_name(const toml::node& node, std::string_view key) {
        if (const auto* const text = node.as_string(); text != nullptr && !text->get().empty()) return text->get();
        reader_.report(node, Weight::Wrong, fmt::format("{} = {}: expected the name of a file", key, show(node)));
        return std::nullopt;
    }

    void read_document(const toml::node& node) {
        if (auto name = file_name(node, "document")) look_.ui->document = std::move(*name);
    }

    void read_controllers(const toml::node& node) {
        constexpr std::size_t most = 16;
        const toml::array* const names = node.as_array();
        if (names == nullptr || names->size() > most)
            return reader_.report(
                node, Weight::Wrong,
                fmt::format("controllers = {}: expected a list of at most {} files", show(node), most));
        for (const toml::node& one : *names)
            if (auto name = file_name(one, "controllers")) look_.ui->controllers.push_back(std::move(*name));
    }

    void read_game(const toml::node& node) {
        if (Result<GameTable> values = game_values(node))
            look_.ui->game = std::move(*values);
        else
            reader_.report(node, Weight::Wrong, values.error().text);
    }

    void read_unknown(const toml::key& key, const toml::node& node) {
        // An effect's own name stands for how much of it there is, and where that is the key, so may other words.
        std::string meant;
        for (const auto& [name, target] : targets_) {
            const std::string_view effect = target.entry->effect->name;
            const bool is_own = name == effect && key.str().starts_with(effect) && stands_for_amount(key.str(), effect);
            if (is_own || (effect == key.str() && target.row->is_amount)) meant = name;
        }
        reader_.report_unknown(
            key, node, names_, [&](const std::string& near) { return allowed(near); }, meant);
    }

    LookReader& reader_;
    Look& look_;
    bool is_of_ui_;
    std::map<std::string, Target, std::less<>> targets_;
    std::vector<std::string> names_ = is_of_ui_ ? std::vector<std::string>{"document", "controllers", "game"}
                                                : std::vector<std::string>{"enabled", "order"};  // for suggestions
};

}  // namespace

Look read_flat(LookReader& reader, const toml::node* node) {
    const auto with_lens = [&](Look look) {
        for (LookEntry& entry : look.entries)
            reader.put_lens(entry, [&](std::string_view row) {
                return std::ranges::any_of(look.written, [&](const WrittenValue& value) {
                    return value.effect == entry.effect && value.parameter == row;
                });
            });
        return look;
    };
    if (node == nullptr) return with_lens(default_look());
    const toml::table* const table = node->as_table();
    // Files that name no order were made for the documented one, whose defaults lie under what they say.
    const std::optional<std::string> order = table == nullptr ? std::nullopt : (*table)["order"].value<std::string>();
    Look look =
        default_look(order == order_names[static_cast<std::size_t>(LookOrder::SceneLinear)] ? LookOrder::SceneLinear
                                                                                            : LookOrder::Documented);
    if (table != nullptr)
        FlatReader(reader, look, false).read(*table);
    else
        reader.report(*node, Weight::Wrong, fmt::format("post_process = {}: expected a table", show(*node)));
    return with_lens(std::move(look));
}

void read_ui(LookReader& reader, Look& look, const toml::node& node) {
    const toml::table* const table = node.as_table();
    if (table == nullptr)
        return reader.report(node, Weight::Wrong, fmt::format("ui = {}: expected a table", show(node)));
    add_ui(look);
    FlatReader(reader, look, true).read(*table);
}

}  // namespace darkroom
