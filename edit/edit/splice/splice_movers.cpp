// SPDX-License-Identifier: MIT
#include "edit/splice/splice_movers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

#include "core/text/param_text.hpp"
#include "edit/follow/moved_values.hpp"
#include "edit/splice/list_blocks.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"
#include "toml/toml_text.hpp"

namespace darkroom::edit {

namespace {

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

}  // namespace

Result<> splice_movers(TomlEditor& editor, const Look& was, const Look& is) {
    return MoverSplicer(editor, was, is).run();
}

}  // namespace darkroom::edit
