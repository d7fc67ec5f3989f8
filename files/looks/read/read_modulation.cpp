// SPDX-License-Identifier: MIT
// [[pulse]] and [[layer]]: what moves the values of a look while the picture runs.
#include <fmt/format.h>

#include <algorithm>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/read/look_reader.hpp"

namespace darkroom {

namespace {

/// The number with which the effect changes nothing at 0; null: it has none.
const ParamInfo* amount_of(const LookEntry& entry) {
    for (const ParamInfo& row : entry.effect->parameters.rows)
        if (row.is_amount && row.kind == Kind::Float && row.range.min <= 0) return &row;
    return nullptr;
}

}  // namespace

void wake(LookEntry& entry) {
    const ParamInfo* const amount = amount_of(entry);
    if (entry.state.enabled.on != 0 || amount == nullptr) return;
    entry.state.enabled = true;
    entry.words[amount->word] = 0;
}

namespace {

class ModulationReader {
  public:
    ModulationReader(LookReader& reader, Look& look) : reader_(reader), look_(look), names_(entry_names(look)) {}

    void read(const toml::table& file) {
        for_each(file, "pulse", max_pulses, [&](const toml::table& table) { read_pulse(table); });
        for_each(file, "layer", max_layers, [&](const toml::table& table) { read_layer(table); });
    }

  private:
    template <class Read>
    void for_each(const toml::table& file, std::string_view key, std::size_t most, const Read& read) {
        const toml::node* const node = file.get(key);
        if (node == nullptr) return;
        const toml::array* const array = node->as_array();
        if (array == nullptr)
            return wrong(*node, fmt::format("{} = {}: expected [[{}]] entries", key, show(*node), key));
        if (array->size() > most)
            return wrong(*node, fmt::format("{} entries of {}: allowed are {}", array->size(), key, most));
        for (const toml::node& one : *array) {
            if (const toml::table* const table = one.as_table())
                read(*table);
            else
                wrong(one, fmt::format("an entry of {} is {}: expected a table", key, show(one)));
        }
    }

    void wrong(const toml::node& node, std::string text) { reader_.report(node, Weight::Wrong, std::move(text)); }

    /// The string of a required key; empty, and reported, if the key is missing or not a string.
    std::string text_of(const toml::table& table, std::string_view of, std::string_view key, bool is_name) {
        const toml::node* const node = table.get(key);
        if (node == nullptr) {
            wrong(table, fmt::format("{} has no key '{}'", of, key));
            return {};
        }
        const auto* const text = node->as_string();
        if (text != nullptr && (is_name ? is_look_name(text->get()) : !text->get().empty())) return text->get();
        wrong(*node, fmt::format("{} = {}: expected a name{}", key, show(*node),
                                 is_name ? " of letters, digits, '_' and '-'" : ""));
        return {};
    }

    /// Takes the keys of a described struct; what is left is unknown.
    template <class State>
    void take_rows(const toml::table& table, const ParamTable& rows, State& state,
                   std::initializer_list<std::string_view> others) {
        auto words = std::bit_cast<std::array<std::uint32_t, sizeof(State) / 4>>(state);
        std::vector<std::string> known(others.begin(), others.end());
        for (const ParamInfo& row : rows.rows) known.emplace_back(row.name);
        for (const auto& [key, node] : table) {
            if (std::ranges::count(others, key.str()) > 0) continue;
            if (const ParamInfo* const row = rows.find(key.str()))
                reader_.take(*row, words, node, key.str());
            else
                reader_.report_unknown(key, node, known, [&](const std::string& near) {
                    const ParamInfo* const row_near = rows.find(near);
                    return row_near == nullptr ? std::string("another kind of value") : interval(*row_near);
                });
        }
        state = std::bit_cast<State>(words);
    }

    std::string name_of(const LookEntry* entry) const {
        return names_[static_cast<std::size_t>(entry - look_.entries.data())];
    }

    /// A parameter that can move; one of no entry, and reported, where it cannot.
    LookTarget target_of(const toml::node& node, const std::string& key) {
        const Result<LookTarget> target = find_target(look_, key, printable(key));
        if (!target) {
            wrong(node, target.error().text);
            return {};
        }
        const bool is_own = target->is_state && target->row->name != "enabled" && target->row->name != "opacity";
        if (target->row != nullptr && !is_own && target->row->kind != Kind::Resource) return *target;
        wrong(node,
              fmt::format(
                  "{}: it is fixed when the stack is compiled, and cannot move; allowed are parameters, `enabled` and "
                  "`opacity`",
                  printable(key)));
        return {};
    }

    void read_pulse(const toml::table& table) {
        LookPulse pulse{.event = text_of(table, "a pulse", "event", true)};
        take_rows(table, pulse_rows, pulse.state, {"event", "parameter", "amount"});
        const std::string key = text_of(table, "a pulse", "parameter", false);
        const LookTarget target = key.empty() ? LookTarget() : target_of(*table.get("parameter"), key);
        if (pulse.event.empty() || target.entry == nullptr) return;
        pulse.entry = name_of(target.entry);
        pulse.parameter = target.row->name;
        const Kind kind = target.row->kind;
        if (target.is_state || kind == Kind::Toggle || kind == Kind::Choice || kind == Kind::Curve)
            return wrong(*table.get("parameter"),
                         fmt::format("{}: a pulse adds to parameters made of numbers", printable(key)));
        if (target.row->is_amount) wake(*target.entry);
        if (read_amount(table, target.row->words, pulse.amount)) look_.pulses.push_back(std::move(pulse));
    }

    bool read_amount(const toml::table& table, std::uint32_t count, std::array<float, 4>& amount) {
        const toml::node* const node = table.get("amount");
        if (node == nullptr) {
            wrong(table, "a pulse has no key 'amount'");
            return false;
        }
        constexpr std::array kinds{Kind::Float, Kind::Vec2, Kind::Vec3, Kind::Vec4};
        const bool is_one = node->is_number();
        ParamInfo row{.name = "amount", .range = {-max_amount, max_amount}, .kind = kinds[is_one ? 0 : count - 1]};
        row.words = is_one ? 1 : count;
        std::array<std::uint32_t, 4> words{};
        if (!reader_.take(row, words, *node, "amount")) return false;
        for (std::size_t i = 0; i < amount.size(); ++i) amount[i] = std::bit_cast<float>(words[is_one ? 0 : i]);
        return true;
    }

    void read_layer(const toml::table& table) {
        LookLayer layer{.name = text_of(table, "a layer", "name", true)};
        const toml::node *const file = table.get("look"), *const values = table.get("values"),
                                *const distance = table.get("distance");
        // What a distance alone drives is all there near its point.
        if (distance != nullptr) layer.state.weight = 1;
        take_rows(table, layer_rows, layer.state, {"name", "look", "values", "distance"});
        if (distance != nullptr) read_distance(*distance, layer);
        if ((file == nullptr) == (values == nullptr)) return wrong(table, "a layer has either a 'look' or 'values'");
        if (file != nullptr)
            read_file(table, layer);
        else
            read_values(*values, layer);
        const bool is_taken = std::ranges::count(look_.layers, layer.name, &LookLayer::name) > 0;
        if (is_taken) return wrong(*table.get("name"), fmt::format("two layers are named '{}'", layer.name));
        if (!layer.name.empty() && !layer.values.empty()) look_.layers.push_back(std::move(layer));
    }

    void read_distance(const toml::node& node, LookLayer& layer) {
        const toml::table* const table = node.as_table();
        if (table == nullptr)
            return wrong(node, fmt::format("distance = {}: expected {{ near, far, point }}", show(node)));
        layer.distance.emplace();
        take_rows(*table, distance_rows, *layer.distance, {});
        if (!(layer.distance->near < layer.distance->far))
            wrong(node, fmt::format("distance: near = {} and far = {}: allowed is near < far", layer.distance->near,
                                    layer.distance->far));
    }

    void read_values(const toml::node& node, LookLayer& layer) {
        const toml::table* const table = node.as_table();
        if (table == nullptr || table->empty())
            return wrong(node, fmt::format("values = {}: expected a table of values", show(node)));
        for (const auto& [key, value] : *table) {
            const std::string name(key.str());
            // An unquoted dot makes a table of its own.
            const toml::table* const of_entry = find_entry(look_, name) == nullptr ? nullptr : value.as_table();
            if (of_entry == nullptr) {
                read_value(value, name, layer);
                continue;
            }
            for (const auto& [parameter, own] : *of_entry)
                read_value(own, fmt::format("{}.{}", name, parameter.str()), layer);
        }
    }

    void read_value(const toml::node& node, const std::string& key, LookLayer& layer) {
        const LookTarget target = target_of(node, key);
        if (target.entry == nullptr) return;
        const ParamInfo& row = *target.row;
        if (row.is_amount) wake(*target.entry);
        std::vector<std::uint32_t> words = target.entry->words;
        if (target.is_state) {
            const StateWords state = state_words(target.entry->state);
            words.assign(state.begin(), state.end());
        }
        if (!reader_.take(row, words, node, printable(key))) return;
        layer.values.push_back({name_of(target.entry),
                                std::string(row.name),
                                {words.begin() + row.word, words.begin() + row.word + row.words}});
    }

    void read_file(const toml::table& table, LookLayer& layer) {
        layer.file = text_of(table, "a layer", "look", false);
        if (layer.file.empty()) return;
        const toml::node& node = *table.get("look");
        Result<std::vector<LookLayer::Value>> values = layer_values(look_, layer.file, reader_.options());
        if (!values) return wrong(node, fmt::format("look = {}: {}", show(node), values.error().text));
        layer.values = std::move(*values);
        if (layer.values.empty())
            reader_.report(node, Weight::Slip, fmt::format("look = {}: a look cannot be its own layer", show(node)));
    }

    LookReader& reader_;
    Look& look_;
    std::vector<std::string> names_;
};

}  // namespace

void read_modulation(LookReader& reader, const toml::table& file, Look& look) {
    ModulationReader(reader, look).read(file);
}

}  // namespace darkroom
