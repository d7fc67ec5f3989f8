// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/effect.hpp>
#include <map>

#include "core/text/param_text.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

class Checker {
  public:
    Checker(const Look& look, const std::function<std::string(std::size_t)>& shown) : look_(look), shown_(shown) {}

    std::vector<LookProblem> run() {
        check_names();
        check_wires();
        for (std::size_t i = 0; i < look_.entries.size(); ++i)
            if (const std::string conflict = conflict_of(look_.entries[i]); !conflict.empty())
                report(i, {}, fmt::format("{}: {}", shown_(i), conflict));
        return std::move(out_);
    }

  private:
    static constexpr std::size_t max_suggestions = 256;  // looking for names is slow

    void report(std::size_t entry, std::string_view key, std::string text) {
        out_.push_back({entry, key, std::move(text)});
    }

    void check_names() {
        const std::vector<std::string> names = entry_names(look_);
        std::map<std::string, std::size_t> first;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const LookEntry& entry = look_.entries[i];
            const auto [found, is_new] = first.try_emplace(names[i], i);
            if (entry.name.empty() && is_new) continue;
            const std::size_t said = entry.name.empty() ? found->second : i;
            const bool has_name = !look_.entries[said].name.empty();
            const auto tell = [&](std::string text) {
                report(has_name ? said : i, has_name ? "name" : "", std::move(text));
            };
            if (!is_new)
                tell(fmt::format("name '{}' is that of {} and of {}", names[i], shown_(found->second), shown_(i)));
            else if (const EffectInfo* const effect = find_effect(entry.name);
                     effect != nullptr && effect != entry.effect)
                tell(fmt::format("name '{}' of {} is that of another effect", entry.name, shown_(i)));
        }
    }

    void check_wires() {
        std::map<std::string, std::size_t> makers;
        for (std::size_t i = 0; i < look_.entries.size(); ++i) {
            const std::string& output = look_.entries[i].output;
            if (output.empty()) continue;
            if (std::ranges::find(given_wires, output, &GivenWire::first) != given_wires.end()) {
                report(i, "output",
                       fmt::format("output '{}' of {}: this name is that of what frames bring", output, shown_(i)));
                continue;
            }
            const auto [found, is_new] = makers.try_emplace(output, i);
            if (!is_new)
                report(i, "output",
                       fmt::format("output '{}' is made by {} and by {}", output, shown_(found->second), shown_(i)));
        }
        std::vector<std::string> known;
        for (const auto& [name, handle] : given_wires) known.emplace_back(name);
        for (const auto& [name, maker] : makers) known.push_back(name);
        for (std::size_t i = 0; i < look_.entries.size(); ++i)
            for (const WireInfo& wire : wires)
                if (wire.is_reference) check_wire(i, wire, makers, known);
    }

    void check_wire(std::size_t index, const WireInfo& wire, const std::map<std::string, std::size_t>& makers,
                    std::span<const std::string> known) {
        std::string name = look_.entries[index].*wire.member;
        if (is_file_name(name)) return;
        const bool is_previous = name.ends_with(previous_suffix);
        if (is_previous) name.resize(name.size() - previous_suffix.size());
        const bool is_given = std::ranges::find(given_wires, name, &GivenWire::first) != given_wires.end();
        if (name.empty() || name == scene_name || (is_given && !is_previous)) return;
        const auto found = makers.find(name);
        if (found == makers.end())
            return report(index, wire.key,
                          fmt::format("{} = \"{}\" of {}: no entry has this output{}", wire.key, name, shown_(index),
                                      out_.size() < max_suggestions ? alternatives(name, known, "known are") : ""));
        if (found->second < index || is_previous) return;
        report(index, wire.key,
               fmt::format("{} = \"{}\" of {}: made only later, by {}", wire.key, name, shown_(index),
                           found->second == index ? "itself" : shown_(found->second)));
    }

    const Look& look_;
    const std::function<std::string(std::size_t)>& shown_;
    std::vector<LookProblem> out_;
};

}  // namespace

std::vector<LookProblem> problems_of(const Look& look, const std::function<std::string(std::size_t)>& shown) {
    return Checker(look, shown).run();
}

}  // namespace darkroom
