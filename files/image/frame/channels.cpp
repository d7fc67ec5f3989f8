// SPDX-License-Identifier: MIT
#include "image/frame/channels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <unordered_map>

#include "core/text/lower.hpp"
#include "core/text/param_text.hpp"

namespace darkroom {
namespace {

std::string last_component(std::string_view name) { return lower(name.substr(name.rfind('.') + 1)); }

std::string_view parent(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
}

// The channels of a part that share what is before the last dot.
struct Layer {
    std::size_t part = 0;
    std::string prefix;
    std::string name;  // the prefix or, in files of several parts, the name of the part where the prefix is empty
    std::string view;  // of a stereo picture, as far as it is known
    std::map<std::string, int> components;  // in lower case

    [[nodiscard]] int channel(std::string_view component) const {
        const auto found = components.find(std::string(component));
        return found == components.end() ? -1 : found->second;
    }
    [[nodiscard]] bool has(std::string_view letters) const {
        return std::all_of(letters.begin(), letters.end(),
                           [&](char letter) { return channel(std::string_view(&letter, 1)) >= 0; });
    }
    [[nodiscard]] ChannelSet set(std::string_view letters) const {
        ChannelSet result{.part = part, .channels = {-1, -1, -1, -1}, .prefix = name};
        for (std::size_t i = 0; i < letters.size(); ++i) result.channels[i] = channel(letters.substr(i, 1));
        return result;
    }
    [[nodiscard]] bool is_plain() const { return prefix.empty(); }
};

struct ViewedPrefix {
    std::string_view view, prefix;
};

// Of a part that views share: the view is the last component before the channel, or the first view where there is none
// ("Technical Introduction to OpenEXR", section "Multi-View OpenEXR").
ViewedPrefix split_view(const FilePart& part, std::string_view prefix) {
    if (part.views.empty()) return {part.view, prefix};
    const std::string_view last = prefix.substr(prefix.rfind('.') + 1);
    if (std::find(part.views.begin(), part.views.end(), last) != part.views.end()) return {last, parent(prefix)};
    return {prefix.empty() ? std::string_view(part.views.front()) : std::string_view(), prefix};
}

// Is what follows the word a number, and nothing but that?
bool is_numbered(std::string_view name, std::string_view word) {
    return name.size() > word.size() && name.starts_with(word) &&
           name.find_first_not_of("0123456789", word.size()) == std::string_view::npos;
}

// Shadows beside a frame change nothing of how its layers are found.
std::size_t count_frame_parts(std::span<const FilePart> parts) {
    return parts.size() - static_cast<std::size_t>(std::count_if(parts.begin(), parts.end(), is_shadow_part));
}

std::vector<Layer> layers_of(std::span<const FilePart> parts) {
    std::vector<Layer> layers;
    const bool has_several = count_frame_parts(parts) > 1;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        if (is_shadow_part(parts[part])) continue;
        std::unordered_map<std::string_view, std::size_t> places;  // of this part's layers
        for (std::size_t i = 0; i < parts[part].channels.size(); ++i) {
            const std::string& channel = parts[part].channels[i];
            const std::string_view whole = parent(channel);
            const auto [place, is_new] = places.try_emplace(whole, layers.size());
            if (is_new) {
                const auto [view, prefix] = split_view(parts[part], whole);
                const std::string name(prefix.empty() && has_several ? parts[part].name : prefix);
                layers.push_back(Layer{part, std::string(prefix), name, std::string(view), {}});
            }
            layers[place->second].components.emplace(last_component(channel), static_cast<int>(i));
        }
    }
    for (Layer& layer : layers) {
        if (layer.channel("red") < 0 || layer.channel("green") < 0 || layer.channel("blue") < 0) continue;
        for (const std::string_view name : {"red", "green", "blue", "alpha"})
            if (const int channel = layer.channel(name); channel >= 0)
                layer.components.emplace(name.substr(0, 1), channel);
    }
    return layers;
}

std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t most = 24;
    std::vector<std::string> shown;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) shown.push_back(one_printable_line(names[i]));
    std::string text = fmt::format("{}", fmt::join(shown, ", "));
    if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
    return text;
}

class Finder {
  public:
    Finder(std::span<const FilePart> parts, LayerNames names, std::string view)
        : parts_(parts),
          names_(std::move(names)),
          view_(std::move(view)),
          part_count_(count_frame_parts(parts)),
          layers_(layers_of(parts)) {}

    Result<FrameChannels> find();

  private:
    [[nodiscard]] const std::string* mapped(std::string_view what) const {
        const auto found = names_.find(what);
        return found == names_.end() ? nullptr : &found->second;
    }
    [[nodiscard]] Failure unknown(std::string_view what, const std::string& name) const;
    [[nodiscard]] Result<ChannelSet> mapped_set(std::string_view what, const std::string& name,
                                                std::span<const std::string_view> components) const;
    [[nodiscard]] std::optional<ChannelSet> lone_channel(const std::string& name) const;
    [[nodiscard]] const Layer* layer_of(const ChannelSet& channel) const;
    [[nodiscard]] const Layer* find_named_color(FrameChannels& found) const;
    [[nodiscard]] bool is_same_view(const Layer& layer) const;
    [[nodiscard]] bool is_of_other_view_layer(const Layer& layer) const;
    template <class Accept>
    [[nodiscard]] const Layer* best(const Accept& accept) const;

    [[nodiscard]] Result<> choose_view(FrameChannels& found);
    Result<> find_color(FrameChannels& found) const;
    Result<> find_depth(FrameChannels& found) const;
    Result<> find_normals(FrameChannels& found) const;
    Result<> find_velocity(FrameChannels& found) const;
    void find_masks(FrameChannels& found) const;

    std::span<const FilePart> parts_;
    LayerNames names_;
    std::string view_;            // of the colour, once that is found
    std::size_t part_count_ = 0;  // without shadows
    std::vector<Layer> layers_;
    ChannelSet color_;
    mutable const Layer* passed_over_ = nullptr;  // by the last best(): it would do, and is another view layer's
};

Failure Finder::unknown(std::string_view what, const std::string& name) const {
    std::vector<std::string> candidates;
    for (const std::string& channel : channel_names(parts_)) candidates.push_back(one_printable_line(channel));
    for (const Layer& layer : layers_)
        if (!layer.name.empty()) candidates.push_back(one_printable_line(layer.name));
    return user_error(fmt::format("has no channels \"{}\" for {}{}", one_printable_line(name), what,
                                  alternatives(name, candidates, "there are")));
}

std::optional<ChannelSet> Finder::lone_channel(const std::string& name) const {
    for (std::size_t part = 0; part < parts_.size(); ++part)
        for (std::size_t i = 0; i < parts_[part].channels.size(); ++i) {
            const std::string& channel = parts_[part].channels[i];
            if (channel == name || (parts_.size() > 1 && parts_[part].name + "." + channel == name))
                return ChannelSet{.part = part, .channels = {static_cast<int>(i), -1, -1, -1}, .prefix = name};
        }
    return std::nullopt;
}

const Layer* Finder::layer_of(const ChannelSet& channel) const {
    for (const Layer& layer : layers_)
        for (const auto& [component, index] : layer.components)
            if (layer.part == channel.part && index == channel.channels[0]) return &layer;
    return nullptr;
}

// By the layer's name, by one of its channels, or as `info` tells two layers of one name apart: "1.beauty" of part 1.
Result<ChannelSet> Finder::mapped_set(std::string_view what, const std::string& name,
                                      std::span<const std::string_view> components) const {
    const Layer* known = nullptr;
    const auto set_of = [&](const Layer& layer) -> std::optional<ChannelSet> {
        known = &layer;
        for (const std::string_view letters : components)
            if (layer.has(letters)) return layer.set(letters);
        return std::nullopt;
    };
    for (const Layer& layer : layers_)
        if (layer.name == name || (layer.prefix == name && !name.empty()))
            if (const auto set = set_of(layer)) return *set;
    if (const std::optional<ChannelSet> lone = lone_channel(name); lone && known == nullptr)
        if (const Layer* const layer = layer_of(*lone))
            if (const auto set = set_of(*layer)) return *set;
    for (const Layer& layer : layers_)
        if (known == nullptr && fmt::format("{}.{}", layer.part, layer.name) == name)
            if (const auto set = set_of(layer)) return *set;
    if (known == nullptr) return unknown(what, name);
    return user_error(fmt::format("the layer \"{}\" lacks the components {} that {} needs", one_printable_line(name),
                                  components.front(), what));
}

bool Finder::is_same_view(const Layer& layer) const {
    return view_.empty() || layer.view.empty() || view_ == layer.view;
}

// Blender's Composite is made of view layers; what goes with it may be of any.
bool Finder::is_of_other_view_layer(const Layer& layer) const {
    const std::string_view own = parent(color_.prefix), other = parent(layer.name);
    return !own.empty() && !other.empty() && own != other && last_component(own) != "composite";
}

// The first layer that is accepted, but one of the colour's own view layer before others.
template <class Accept>
const Layer* Finder::best(const Accept& accept) const {
    const Layer* result = nullptr;
    for (const Layer& layer : layers_) {
        if (!is_same_view(layer) || !accept(layer)) continue;
        if (is_of_other_view_layer(layer)) {
            passed_over_ = &layer;
            continue;
        }
        if (parent(layer.name) == parent(color_.prefix)) return &layer;
        if (result == nullptr) result = &layer;
    }
    return result;
}

Result<> Finder::choose_view(FrameChannels& found) {
    for (const Layer& layer : layers_)
        if (!layer.view.empty() && std::find(found.views.begin(), found.views.end(), layer.view) == found.views.end())
            found.views.push_back(layer.view);
    std::string kept = view_;
    if (kept.empty() && !parts_.empty() && !parts_.front().views.empty()) kept = parts_.front().views.front();
    if (!view_.empty() && std::find(found.views.begin(), found.views.end(), view_) == found.views.end())
        return user_error(fmt::format("has no view \"{}\"; it has {}", one_printable_line(view_),
                                      found.views.empty() ? "one picture alone" : listed(found.views)));
    if (kept.empty()) return {};
    std::erase_if(layers_, [&](const Layer& layer) { return !layer.view.empty() && layer.view != kept; });
    std::stable_partition(layers_.begin(), layers_.end(), [](const Layer& layer) { return !layer.view.empty(); });
    return {};
}

const Layer* Finder::find_named_color(FrameChannels& found) const {
    // How early a layer is taken; what is no picture, last of all.
    constexpr std::array<std::string_view, 6> by_last{"combined", "rgba", "rgb", "c", "beauty", "default"};
    constexpr std::size_t plain = by_last.size() + 2, gray = plain + 1, any = gray + 1, last_gray = any + 1,
                          never = last_gray + 1;
    const auto rank = [&](const Layer& layer) -> std::size_t {
        const bool is_gray = !layer.has("rgb");
        const bool is_tristimulus = layer.is_plain() && layer.has("xyz") && parts_[layer.part].has_primaries;
        if (is_gray && is_tristimulus) return plain;
        if (is_gray && !(layer.is_plain() && layer.has("y") && !layer.has("x"))) return never;
        if (part_count_ == 1 && layer.is_plain()) return is_gray ? gray : 0;
        const std::string name = lower(layer.name), last = last_component(layer.name);
        if (last == "composite" || last_component(parent(layer.name)) == "composite") return 1;
        const auto* const known = std::ranges::find(by_last, last);
        if (known != by_last.end()) return 2 + static_cast<std::size_t>(known - by_last.begin());
        if (layer.is_plain() && !is_gray) return plain;
        const auto has_word = [&](std::string_view word) { return name.find(word) != std::string::npos; };
        const bool is_data = last == "n" || last == "p" || last == "vector" || has_word("crypto") ||
                             has_word("normal") || has_word("depth") || has_word("velocity") || has_word("motion") ||
                             has_word("transparency") || has_word("position") || has_word("matte");
        if (is_gray) return is_data ? last_gray : gray;
        return is_data ? never : any;
    };
    const Layer* best = nullptr;
    std::size_t least = never;
    for (const Layer& layer : layers_)
        if (const std::size_t own = rank(layer); own < least) {
            best = &layer;
            least = own;
        }
    // That there are other views is told by their names.
    for (const Layer& layer : layers_)
        if (best != nullptr && &layer != best && (layer.view.empty() || layer.view == best->view) &&
            (rank(layer) == least || (least == gray && rank(layer) == any)))
            found.other_colors.push_back(layer.name);
    return best;
}

Result<> Finder::find_color(FrameChannels& found) const {
    if (const std::string* name = mapped("color")) {
        constexpr std::array<std::string_view, 2> components{"rgb", "xyz"};
        const auto lone = lone_channel(*name);
        const Layer* const of_lone = lone ? layer_of(*lone) : nullptr;
        // Red without a layer's name stands for the three.
        const bool is_whole = of_lone != nullptr && of_lone->is_plain() && of_lone->has("rgb") &&
                              of_lone->channel("r") == lone->channels[0];
        if (is_whole) {
            found.color = of_lone->set("rgba");
            return {};
        }
        if (lone) {
            found.color = *lone;
            found.is_gray = true;
            found.color.channels = {lone->channels[0], lone->channels[0], lone->channels[0], -1};
            return {};
        }
        DARKROOM_TRY_VALUE(auto set, mapped_set("color", *name, components));
        found.color = set;
        for (const Layer& layer : layers_)
            if (layer.part == set.part && layer.name == set.prefix) found.color.channels[3] = layer.channel("a");
        return {};
    }
    const auto first = [&](const auto& accept) {
        const auto layer = std::find_if(layers_.begin(), layers_.end(), accept);
        return layer == layers_.end() ? nullptr : &*layer;
    };
    const Layer* layer = find_named_color(found);
    if (layer != nullptr && (layer->has("rgb") || layer->has("xyz"))) {
        found.color = layer->set(layer->has("rgb") ? "rgba" : "xyza");
        return {};
    }
    if (layer == nullptr && part_count_ == 1)
        layer = first([&](const Layer& l) {
            const std::size_t count = parts_[l.part].channels.size() - (l.has("a") ? 1 : 0);
            return l.is_plain() && count == 1 && !l.has("z") && l.channel("depth") < 0;
        });
    if (layer == nullptr)
        return user_error(fmt::format("has no color: channels found: {}; needed: R, G, B or Y, or a mapping of color",
                                      listed(channel_names(parts_))));
    int gray = layer->channel("y");
    for (const auto& [component, channel] : layer->components)
        if (gray < 0 && component != "a") gray = channel;
    found.is_gray = true;
    found.color = ChannelSet{layer->part, {gray, gray, gray, layer->channel("a")}, layer->name};
    return {};
}

// Unreal Engine's Movie Render Queue names its pass FinalImageMovieRenderQueue_WorldDepth, in centimetres.
bool is_of_unreal(std::string_view name) { return lower(name).ends_with("worlddepth"); }
float scale_of_depth(std::string_view name) { return is_of_unreal(name) ? 0.01F : 1.0F; }

// Mitsuba's, under any name: "dd.y:depth" makes it dd.y.T.
bool is_length_of_ray(const Layer& layer) {
    return !layer.name.empty() && layer.components.size() == 1 && layer.channel("t") >= 0;
}

Result<> Finder::find_depth(FrameChannels& found) const {
    if (const std::string* name = mapped("depth")) {
        if (*name == no_layer) return {};
        constexpr std::array<std::string_view, 3> components{"z", "v", "t"};
        found.depth = lone_channel(*name);
        if (!found.depth) {
            DARKROOM_TRY_VALUE(found.depth, mapped_set("depth", *name, components));
        }
        const Layer* const of_ray = layer_of(*found.depth);
        found.is_depth_along_ray = of_ray != nullptr && is_length_of_ray(*of_ray);
        if (found.is_depth_along_ray) found.depth->prefix = of_ray->name;
        return {};
    }
    // Along the ray, from the near clip on, filtered, and 3.4e38 where nothing is.
    const auto is_denoising = [](const Layer& l) { return last_component(l.name) == "denoising depth"; };
    const auto is_lone_z = [&](const Layer& l) { return l.has("z") && !l.has("x") && !is_denoising(l); };
    const Layer* layer = nullptr;
    if (part_count_ == 1) layer = best([&](const Layer& l) { return l.is_plain() && is_lone_z(l); });
    if (layer == nullptr)
        layer = best([&](const Layer& l) { return last_component(l.name) == "depth" && is_lone_z(l); });
    if (layer == nullptr)
        layer = best([&](const Layer& l) { return lower(l.name).find("depth") != std::string::npos && is_lone_z(l); });
    if (layer == nullptr)
        layer = best([&](const Layer& l) { return l.is_plain() && l.part == color_.part && is_lone_z(l); });
    if (layer == nullptr) layer = best([&](const Layer& l) { return l.is_plain() && is_lone_z(l); });
    if (layer != nullptr) {
        found.depth = layer->set("z");
        found.depth_scale = scale_of_depth(layer->name);
        return {};
    }
    for (const std::string_view name : {"depth", "hitpz", "pz"}) {
        const auto names_channel = [&](const Layer& l) { return l.is_plain() && l.channel(name) >= 0; };
        const auto is_named = [&](const Layer& l) {
            return last_component(l.name) == name && l.components.size() == 1;
        };
        if ((layer = best(names_channel)) == nullptr && (layer = best(is_named)) == nullptr) continue;
        const int channel = names_channel(*layer) ? layer->channel(name) : layer->components.begin()->second;
        found.is_depth_along_ray = is_length_of_ray(*layer);
        found.depth = ChannelSet{layer->part, {channel, -1, -1, -1}, layer->name};
        return {};
    }
    if ((layer = best(is_length_of_ray)) != nullptr) {
        found.is_depth_along_ray = true;
        found.depth = layer->set("t");
        return {};
    }
    layer = best([](const Layer& l) { return is_of_unreal(l.name) && l.has("r"); });
    if (layer == nullptr) {
        if (std::ranges::any_of(layers_, is_denoising))
            found.left_out.emplace_back(
                "Denoising Depth is no distance along the view axis: left out; Blender's pass Z is");
        return {};
    }
    found.depth = layer->set("r");
    found.depth_scale = scale_of_depth(layer->name);
    return {};
}

Result<> Finder::find_normals(FrameChannels& found) const {
    if (const std::string* name = mapped("normals")) {
        if (*name == no_layer) return {};
        constexpr std::array<std::string_view, 2> components{"xyz", "rgb"};
        DARKROOM_TRY_VALUE(found.normals, mapped_set("normals", *name, components));
        return {};
    }
    // Those of Mitsuba's manual are the last two.
    constexpr std::array<std::string_view, 5> known{"n", "normal", "normals", "nn", "sh_normal"};
    const Layer* layer = best([&](const Layer& l) {
        return std::ranges::find(known, last_component(l.name)) != known.end() && l.has("xyz");
    });
    if (layer != nullptr) found.normals = layer->set("xyz");
    return {};
}

// Blender's pass is named Vector and has two motions: X and Y to the previous frame, Z and W to the next.
Result<> Finder::find_velocity(FrameChannels& found) const {
    const auto is_blender = [](const Layer& l) { return last_component(l.name) == "vector" && l.has("xyzw"); };
    if (const std::string* name = mapped("velocity")) {
        if (*name == no_layer) return {};
        constexpr std::array<std::string_view, 3> components{"xy", "uv", "rg"};
        DARKROOM_TRY_VALUE(auto set, mapped_set("velocity", *name, components));
        found.velocity = set;
        // Its node File Output drops the fourth number.
        found.is_velocity_y_up = std::any_of(layers_.begin(), layers_.end(), [&](const Layer& l) {
            return l.part == set.part && l.name == set.prefix && last_component(l.name) == "vector" && l.has("xyz");
        });
        return {};
    }
    const Layer* layer = best([](const Layer& l) { return last_component(l.name) == "velocity" && l.has("xy"); });
    if (layer == nullptr) {
        layer = best(is_blender);
        found.is_velocity_y_up = layer != nullptr;
    }
    if (layer != nullptr) found.velocity = layer->set("xy");
    return {};
}

void Finder::find_masks(FrameChannels& found) const {
    const Layer* layer = best([](const Layer& l) { return l.is_plain() && l.channel("reactive") >= 0; });
    if (layer != nullptr)
        found.reactive = ChannelSet{layer->part, {layer->channel("reactive"), -1, -1, -1}, layer->name};
    layer = best([](const Layer& l) { return last_component(l.name) == "transparency" && l.has("rgb"); });
    if (layer != nullptr) found.transparency = layer->set("rgb");
}

Result<FrameChannels> Finder::find() {
    for (const auto& [what, name] : names_)
        if (what != "color" && what != "depth" && what != "normals" && what != "velocity")
            return user_error(fmt::format("a mapping of \"{}\"; color, depth, normals and velocity can be mapped",
                                          one_printable_line(what)));
    // As `info` calls what is found without a mapping.
    std::vector<std::string> known;
    std::erase_if(names_, [&](const auto& mapping) {
        const auto& [what, name] = mapping;
        const bool is_known = name == what && !lone_channel(name) && std::ranges::none_of(layers_, [&](const Layer& l) {
                                  return l.name == name || l.prefix == name;
                              });
        if (is_known) known.push_back(name);
        return is_known;
    });
    FrameChannels found;
    DARKROOM_TRY(choose_view(found));
    DARKROOM_TRY(find_color(found));
    color_ = found.color;
    for (const Layer& layer : layers_)
        if (view_.empty() && layer.part == color_.part && layer.name == color_.prefix) view_ = layer.view;
    found.view = view_;
    const auto tell_of_other = [&](std::string_view what, const std::optional<ChannelSet>& set) {
        if (!set && passed_over_ != nullptr)
            found.left_out.push_back(fmt::format(
                "the {0} {1} are of another view layer than the color {2}: left out; --map {0}={1} takes them", what,
                one_printable_line(passed_over_->name), one_printable_line(color_.prefix)));
        passed_over_ = nullptr;
    };
    DARKROOM_TRY(find_depth(found));
    tell_of_other("depth", found.depth);
    DARKROOM_TRY(find_normals(found));
    tell_of_other("normals", found.normals);
    DARKROOM_TRY(find_velocity(found));
    tell_of_other("velocity", found.velocity);
    find_masks(found);
    for (const std::string& what : known)
        if ((what == "depth" && !found.depth) || (what == "normals" && !found.normals) ||
            (what == "velocity" && !found.velocity))
            return unknown(what, what);
    return found;
}

}  // namespace

bool is_shadow_part(const FilePart& part) {
    return is_numbered(part.name, "shadow") &&
           std::all_of(part.channels.begin(), part.channels.end(),
                       [](const auto& name) { return is_numbered(name, "cascade"); });
}

std::vector<std::string> channel_names(std::span<const FilePart> parts) {
    std::vector<std::string> names;
    for (const FilePart& part : parts)
        for (const std::string& channel : part.channels)
            names.push_back(parts.size() > 1 ? part.name + "." + channel : channel);
    return names;
}

Result<FrameChannels> find_channels(std::span<const FilePart> parts, const LayerNames& names, const std::string& view) {
    return Finder(parts, names, view).find();
}

Result<> add_mapping(LayerNames& names, std::string_view mapping) {
    const std::size_t equals = mapping.find('=');
    const std::string what(mapping.substr(0, equals));
    const bool is_known = what == "color" || what == "depth" || what == "normals" || what == "velocity";
    if (equals == std::string_view::npos || equals + 1 == mapping.size() || !is_known)
        return user_error(
            fmt::format("\"{}\" is not a mapping: expected NAME=CHANNEL, NAME one of color, depth, normals, velocity",
                        one_printable_line(mapping)));
    names[what] = mapping.substr(equals + 1);
    return {};
}

}  // namespace darkroom
