// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <darkroom/look.hpp>

#include "core/caught.hpp"
#include "core/text/param_text.hpp"
#include "looks/apply/look_resources.hpp"
#include "looks/look_parts.hpp"

namespace darkroom {

namespace {

class Layer {
  public:
    Layer(Look& look, const Look& layer, const std::filesystem::path& folder, const LookOptions& options)
        : look_(look), layer_(layer), folder_(folder), files_({}, options) {}

    Result<> lay() {
        for (const LookEntry& entry : layer_.entries)
            if (std::ranges::find(layer_.written, entry.effect, &WrittenValue::effect) != layer_.written.end())
                DARKROOM_TRY(lay(entry));
        return {};
    }

  private:
    Result<> lay(const LookEntry& from) {
        const auto is_same = [&](const LookEntry& entry) { return entry.effect == from.effect && !entry.is_of_ui; };
        const auto found = std::ranges::find_if(look_.entries, is_same);
        if (found != look_.entries.end()) return set(*found, from);
        LookEntry made = from;
        DARKROOM_TRY(set(made, from));
        return place_entry(look_, std::move(made));
    }

    Result<> set(LookEntry& to, const LookEntry& from) {
        for (const WrittenValue& value : layer_.written) {
            if (value.effect != from.effect) continue;
            const ParamInfo* const row = from.effect->parameters.find(value.parameter);
            if (row == nullptr || row->is_amount) {
                to.state.enabled = from.state.enabled;
                to.is_asked_for = from.is_asked_for;
            }
            if (row == nullptr) continue;
            if (row->kind != Kind::Resource) {
                std::copy_n(&from.words[row->word], row->words, &to.words[row->word]);
                continue;
            }
            const LookResource* const file = resource_of(from, *row);
            const std::string name = file == nullptr ? "" : std::filesystem::absolute(folder_ / file->file).string();
            DARKROOM_TRY(files_.put(to, *row, name));
        }
        const std::string conflict = conflict_of(to);
        return conflict.empty() ? Result<>{} : user_error(fmt::format("over {}: {}", look_.shown_name, conflict));
    }

    Look& look_;
    const Look& layer_;
    const std::filesystem::path& folder_;
    ResourceFiles files_;
};

}  // namespace

Result<> lay_over(Look& look, const std::filesystem::path& file, const LookOptions& options) try {
    LookOptions own = options;
    own.allows_modulation = false;
    DARKROOM_TRY_VALUE(const Look layer, read_look(file, own));
    if (layer.written.empty() || layer.ui)
        return user_error(fmt::format("{}: a look that is laid over another has values in [post_process], and no [ui]",
                                      layer.shown_name));
    Result<> done = Layer(look, layer, file.parent_path(), options).lay();
    return done ? done : failure(Error{done.error().fault, fmt::format("{}: {}", layer.shown_name, done.error().text)});
} catch (...) {
    return caught("lay_over");
}

}  // namespace darkroom
