// SPDX-License-Identifier: MIT
#include "timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"
#include "looks/read/look_reader.hpp"
#include "toml/toml_text.hpp"

namespace app {

using darkroom::Composer;
using darkroom::Look;
using darkroom::LookTarget;
using darkroom::ParamInfo;
using darkroom::printable;
using darkroom::Result;
using darkroom::show;
using darkroom::user_error;

namespace {

constexpr std::size_t max_events = 65536;
constexpr std::string_view owner = "timeline";
const ParamInfo time_row{.name = "time", .unit = darkroom::unit::seconds, .range = {0, 1e9}};
const ParamInfo over_row{.name = "over", .unit = darkroom::unit::seconds, .range = {0, 1e6}};
const ParamInfo yaw_row{.name = "yaw", .unit = darkroom::unit::degrees, .range = {-3600, 3600}};
const ParamInfo weight_row{.name = "weight", .range = {0, 1}};

}  // namespace

/// Stops at the first error: a file of events is written for one sequence, and nothing in it is a slip.
class TimelineReader {
  public:
    TimelineReader(std::string shown, Look& look) : shown_(std::move(shown)), look_(look) {}

    Result<Timeline> read(const toml::table& file) {
        for (const auto& [key, node] : file)
            if (key.str() != "event") return failure(unknown(key, {"event"}));
        const toml::node* const events = file.get("event");
        const toml::array* const array = events == nullptr ? nullptr : events->as_array();
        if (array == nullptr) return user_error(fmt::format("{}: expected [[event]] entries", shown_));
        if (array->size() > max_events)
            return failure(at(*array, fmt::format("{} events: allowed are {}", array->size(), max_events)));
        for (const toml::node& node : *array) {
            const toml::table* const table = node.as_table();
            if (table == nullptr) return failure(at(node, fmt::format("an event is {}: expected a table", show(node))));
            DARKROOM_TRY(read_event(*table));
        }
        std::ranges::stable_sort(out_.events_, {}, &Timeline::Event::time);
        return std::move(out_);
    }

  private:
    [[nodiscard]] darkroom::Error at(const toml::source_position& place, const std::string& text) const {
        return {darkroom::Fault::User, fmt::format("{}:{}:{}: {}", shown_, place.line, place.column, text)};
    }
    [[nodiscard]] darkroom::Error at(const toml::node& node, const std::string& text) const {
        return at(node.source().begin, text);
    }
    [[nodiscard]] darkroom::Error unknown(const toml::key& key, const std::vector<std::string>& known) const {
        return at(key.source().begin, fmt::format("unknown key '{}'{}", printable(key.str()),
                                                  darkroom::alternatives(key.str(), known, "allowed are")));
    }

    Result<> read_event(const toml::table& table) {
        Timeline::Event event;
        const toml::node* const time = table.get("time");
        if (time == nullptr) return failure(at(table, "an event has no key 'time'"));
        if (table.size() == 1)
            return failure(at(
                table, "the event does nothing: expected set, fire, layer, game, jump, yaw or teleport beside time"));
        for (const auto& [key, node] : table) {
            DARKROOM_TRY(read_key(key, node, event));
        }
        out_.events_.push_back(std::move(event));
        return {};
    }

    Result<> read_key(const toml::key& key, const toml::node& node, Timeline::Event& event) {
        if (key.str() == "time" || key.str() == "over") {
            const bool is_time = key.str() == "time";
            DARKROOM_TRY_VALUE(const float number, read_number(is_time ? time_row : over_row, node, key.str()));
            // Times are kept as they are written: a float has no milliseconds left after some hours.
            (is_time ? event.time : event.over) = node.value<double>().value_or(double{number});
            return {};
        }
        if (key.str() == "fire") return read_fire(node, event);
        if (key.str() == "set")
            return read_table(node, "set", [&](std::string_view name, const toml::node& value) {
                return read_value(std::string(name), value, event);
            });
        if (key.str() == "layer")
            return read_table(node, "layer", [&](std::string_view name, const toml::node& value) {
                return read_weight(std::string(name), value, event);
            });
        if (key.str() == "game") return read_game(node, event.game);
        if (key.str() == "jump") return read_truth(key, node, event.game.is_jump);
        if (key.str() == "teleport") return read_truth(key, node, event.game.is_teleport);
        if (key.str() == "yaw") return read_yaw(key, node, event.game);
        return failure(unknown(key, {"time", "set", "fire", "layer", "over", "game", "jump", "yaw", "teleport"}));
    }

    Result<float> read_number(const ParamInfo& row, const toml::node& node, std::string_view key) {
        std::array<std::uint32_t, 1> words{};
        DARKROOM_TRY(read_words(row, words, node, key));
        return std::bit_cast<float>(words[0]);
    }
    Result<> read_words(const ParamInfo& row, std::span<std::uint32_t> words, const toml::node& node,
                        std::string_view key) {
        const Result<std::optional<darkroom::ParamValue>> read = darkroom::value_for(row, node);
        if (!read) return failure(at(node, fmt::format("{} = {}: {}", key, show(node), read.error().text)));
        const std::optional<darkroom::ParamValue>& value = *read;
        if (!value)
            return failure(at(node, fmt::format("{} = {}: expected {}, allowed is {}", key, show(node),
                                                darkroom::expected_kind(row.kind), darkroom::interval(row))));
        const auto problem = darkroom::try_assign(row, words, *value, key);
        return problem ? failure(at(node, problem->text)) : Result<>{};
    }

    Result<> read_game(const toml::node& node, GameEvent& event) {
        Result<darkroom::GameTable> values = darkroom::game_values(node);
        if (!values) return failure(at(node, values.error().text));
        event.values = std::move(*values);
        return {};
    }
    Result<> read_truth(const toml::key& key, const toml::node& node, bool& out) {
        const auto* const truth = node.as_boolean();
        if (truth == nullptr) return failure(at(node, fmt::format("{} = {}: expected true", key.str(), show(node))));
        out = truth->get();
        return {};
    }
    Result<> read_yaw(const toml::key& key, const toml::node& node, GameEvent& event) {
        DARKROOM_TRY_VALUE(const float yaw, read_number(yaw_row, node, key.str()));
        event.yaw = double{yaw};
        return {};
    }

    template <class Read>
    Result<> read_table(const toml::node& node, std::string_view key, const Read& read) {
        const toml::table* const table = node.as_table();
        if (table == nullptr || table->empty())
            return failure(at(node, fmt::format("{} = {}: expected a table of values", key, show(node))));
        for (const auto& [name, value] : *table) DARKROOM_TRY(read(name.str(), value));
        return {};
    }

    Result<> read_fire(const toml::node& node, Timeline::Event& event) {
        const toml::array* const array = node.as_array();
        const std::size_t count = array == nullptr ? 1 : array->size();
        for (std::size_t i = 0; i < count; ++i) {
            const toml::node& one = array == nullptr ? node : *array->get(i);
            const auto* const name = one.as_string();
            std::vector<std::string> known;
            for (const darkroom::LookPulse& pulse : look_.pulses)
                if (std::ranges::count(known, pulse.event) == 0) known.push_back(pulse.event);
            if (name == nullptr || std::ranges::count(known, name->get()) == 0)
                return failure(at(
                    one, fmt::format("fire = {}: no pulse of {} has this event{}", show(one), look_.shown_name,
                                     darkroom::alternatives(name == nullptr ? "" : name->get(), known, "known are"))));
            event.fired.push_back(name->get());
        }
        return {};
    }

    Result<> read_value(const std::string& key, const toml::node& node, Timeline::Event& event) {
        const Result<LookTarget> target = darkroom::find_target(look_, key, printable(key));
        if (!target) return failure(at(node, target.error().text));
        const darkroom::LookEntry* const entry = target->entry;
        const darkroom::ParamInfo* const row = target->row;
        const bool is_state = target->is_state;
        const bool is_own = is_state && row->name != "enabled" && row->name != "opacity";
        if (row == nullptr || is_own || row->kind == darkroom::Kind::Resource)
            return failure(at(
                node, fmt::format("{}: it is fixed when the stack is compiled; allowed are parameters, `enabled` and "
                                  "`opacity`",
                                  printable(key))));
        std::vector<std::uint32_t> words = entry->words;
        const darkroom::StateWords state = darkroom::state_words(entry->state);
        if (is_state) words.assign(state.begin(), state.end());
        const auto part = [&](std::span<const std::uint32_t> of) {
            return std::vector<std::uint32_t>(of.begin() + row->word, of.begin() + row->word + row->words);
        };
        if (is_state) remember(*entry, row->name, part(state));
        DARKROOM_TRY(read_words(*row, words, node, printable(key)));
        // As in a look and on the command line: an amount that is not 0 switches its effect on.
        const bool is_float = row->kind == darkroom::Kind::Float;
        if (row->is_amount && is_float && entry->state.enabled.on == 0) {
            remember(*entry, "enabled", {0});
            const std::uint32_t is_on = std::bit_cast<float>(words[row->word]) != 0 ? 1 : 0;
            event.values.push_back({name_of(*entry), "enabled", {is_on}, true});
        }
        event.values.push_back({name_of(*entry), std::string(row->name), part(words), is_state});
        if (std::ranges::count(out_.entries_, event.values.back().entry) == 0)
            out_.entries_.push_back(event.values.back().entry);
        return {};
    }

    /// What the look has, for a start from the beginning.
    void remember(const darkroom::LookEntry& entry, std::string_view parameter, std::vector<std::uint32_t> words) {
        const std::string name = name_of(entry);
        const auto is_known = [&](const Timeline::Value& one) {
            return one.entry == name && one.parameter == parameter;
        };
        if (std::ranges::none_of(out_.states_, is_known))
            out_.states_.push_back({name, std::string(parameter), std::move(words), true});
    }

    Result<> read_weight(const std::string& name, const toml::node& node, Timeline::Event& event) {
        const auto found = std::ranges::find(look_.layers, name, &darkroom::LookLayer::name);
        std::vector<std::string> known;
        for (const darkroom::LookLayer& layer : look_.layers) known.push_back(layer.name);
        if (found == look_.layers.end())
            return failure(at(node, fmt::format("layer '{}': {} has none of this name{}", printable(name),
                                                look_.shown_name, darkroom::alternatives(name, known, "known are"))));
        DARKROOM_TRY_VALUE(const float weight, read_number(weight_row, node, printable(name)));
        if (std::ranges::count(out_.ways_, name, &Timeline::Way::layer) == 0)
            out_.ways_.push_back({.layer = name, .first = found->state.weight});
        event.weights.push_back({name, weight});
        return {};
    }

    std::string name_of(const darkroom::LookEntry& entry) const {
        return darkroom::entry_names(look_)[static_cast<std::size_t>(&entry - look_.entries.data())];
    }

    std::string shown_;
    Look& look_;
    Timeline out_;
};

Result<Timeline> Timeline::read(const std::filesystem::path& path, Look& look) {
    const std::string shown = printable(path.string());
    DARKROOM_TRY_VALUE(const std::vector<std::byte> bytes,
                       darkroom::read_file(path, {.max_size = darkroom::max_toml_bytes}));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    DARKROOM_TRY_VALUE(const toml::table file, darkroom::parse_toml(text, shown));
    DARKROOM_TRY_VALUE(Timeline out, TimelineReader(shown, look).read(file));
    for (Way& way : out.ways_) way.from = way.to = double{way.first};
    return out;
}

std::vector<double> Timeline::times() const {
    std::vector<double> out;
    for (const Event& event : events_)
        if (out.empty() || event.time > out.back()) out.push_back(event.time);
    return out;
}

std::vector<GameEvent> Timeline::game() const {
    std::vector<GameEvent> out;
    for (const Event& event : events_) {
        const GameEvent& said = event.game;
        if (said.values.empty() && !said.is_jump && !said.is_teleport && !said.yaw) continue;
        out.push_back(event.game);
        out.back().time = event.time;
    }
    return out;
}

double Timeline::Way::at(double time) const {
    return over > 0 ? std::lerp(from, to, std::clamp((time - start) / over, 0.0, 1.0)) : to;
}

void Timeline::restart(Composer& composer) {
    next_ = 0;
    now_ = states_;
    composer.drop_overrides(owner);
    for (Way& way : ways_)
        way = {.layer = way.layer, .first = way.first, .from = double{way.first}, .to = double{way.first}};
}

void Timeline::follow(const Look& look) {
    const std::vector<std::string> names = darkroom::entry_names(look);
    for (Value& value : states_) {
        const auto found = std::ranges::find(names, value.entry);
        if (found == names.end()) continue;
        const darkroom::StateWords state =
            darkroom::state_words(look.entries[static_cast<std::size_t>(found - names.begin())].state);
        const ParamInfo& row = *darkroom::entry_rows.find(value.parameter);
        value.words.assign(state.begin() + row.word, state.begin() + row.word + row.words);
    }
    now_ = states_;
    for (const Event& event : std::span(events_).first(next_)) take(event);
    is_other_look_ = true;
}

void Timeline::take(const Event& event) {
    for (const Value& value : event.values) {
        const auto same = [&](const Value& other) {
            return other.entry == value.entry && other.parameter == value.parameter && other.is_state == value.is_state;
        };
        const auto found = std::ranges::find_if(now_, same);
        found == now_.end() ? now_.push_back(value) : void(found->words = value.words);
    }
}

Result<> Timeline::advance(Composer& composer, double time) {
    // A moment is that of its frame where they are the same but for rounding.
    constexpr double rounding = 1e-9;
    if (next_ == 0 || time < last_time_) restart(composer);
    last_time_ = time;
    for (; next_ < events_.size() && events_[next_].time <= time + rounding; ++next_) {
        const Event& event = events_[next_];
        take(event);
        for (const Value& value : event.values) DARKROOM_TRY(apply(composer, value));
        for (const std::string& name : event.fired) composer.fire(name, event.time);
        for (const Weight& weight : event.weights) {
            Way& way = *std::ranges::find(ways_, weight.layer, &Way::layer);
            way = {.layer = way.layer,
                   .first = way.first,
                   .start = event.time,
                   .over = event.over,
                   .from = way.at(event.time),
                   .to = double{weight.weight}};
        }
    }
    // A Composer holds no overrides of `enabled` and `opacity`; and entries of another look may have come anew.
    for (const Value& value : now_)
        if (value.is_state || is_other_look_) DARKROOM_TRY(apply(composer, value));
    is_other_look_ = false;
    const std::vector<std::string> layers = ways_.empty() ? std::vector<std::string>() : composer.layer_names();
    for (const Way& way : ways_)
        if (std::ranges::count(layers, way.layer) != 0)
            DARKROOM_TRY(composer.set_layer_weight(way.layer, static_cast<float>(way.at(time))));
    return {};
}

Result<> Timeline::apply(Composer& composer, const Value& value) {
    const auto entry = composer.find(value.entry);
    if (!entry) return {};
    if (value.is_state && value.parameter == "enabled") return composer.set_enabled(*entry, value.words[0] != 0);
    if (value.is_state) return composer.set_opacity(*entry, std::bit_cast<float>(value.words[0]));
    if (composer.info(*entry)->parameters.find(value.parameter) == nullptr) return {};
    return composer.set_override(*entry, value.parameter, owner, value.words);
}

}  // namespace app
