// SPDX-License-Identifier: MIT
#include "dim_bloom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "develop/stack_copy.hpp"
#include "report.hpp"

namespace app {

namespace {

/// The place in the stack of the first effect with a threshold that was asked for and reads the picture before it, or
/// the scene.
std::optional<std::size_t> place_of_bloom(const darkroom::Composer& composer, const darkroom::Look& look) {
    const std::vector<std::string> names = darkroom::entry_names(look);
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const darkroom::Handle entry = composer.entry(i);
        if (composer.info(entry)->threshold == nullptr) continue;
        const darkroom::EntryDesc& desc = *composer.desc(entry);
        if (desc.input.is_given() || (desc.source.is_given() && desc.source != darkroom::scene_color)) continue;
        const auto named = std::ranges::find(names, desc.name);
        const bool is_flat = look.is_flat || look.was_flat;
        if (!is_flat || (named != names.end() && look.entries[named - names.begin()].is_asked_for)) return i;
    }
    return {};
}

template <class Input>
void tell(darkroom::Device& device, const darkroom::Composer& composer, const darkroom::Look& look,
          darkroom::DevelopDesc desc, const Input& input, double time, const darkroom::Camera& camera) {
    if (current_voice() == Voice::Quiet) return;
    const std::optional<std::size_t> place = place_of_bloom(composer, look);
    if (!place) return;
    const darkroom::Composer::EntryValues values = composer.values_at(composer.entry(*place), time, camera);
    if (!values.is_enabled || values.opacity == 0) return;
    const std::optional<float> threshold = composer.info(composer.entry(*place))->threshold(values.words.data());
    if (!threshold) return;
    darkroom::Composer before(device, {.frames_in_flight = 1});
    darkroom::StackCopy stack;
    if (!stack.follow(composer, before, time, camera) || !stack.follow_values(composer, before, time, camera)) return;
    const bool reads_scene = composer.desc(composer.entry(*place))->source.is_given();
    for (std::size_t i = stack.entries().size(); i > (reads_scene ? 0 : *place); --i)
        if (!before.remove(stack.entries()[i - 1].copy)) return;
    desc.target = darkroom::DevelopTarget::SceneLinear;
    desc.color.reset();
    desc.frames_in_flight = 1;
    darkroom::Developer developer(device, desc);
    // A wire from the frame before may lead to what was cut off; nothing is said of such stacks.
    const darkroom::Result<darkroom::DevelopedPicture> picture = developer.develop(before, input);
    if (!picture) return;
    float brightest = 0;
    for (std::size_t i = 0; i + 3 < picture->pixels.size(); i += 4)
        brightest = std::max({brightest, picture->pixels[i], picture->pixels[i + 1], picture->pixels[i + 2]});
    if (brightest > *threshold) return;
    complain(fmt::format("{}: nothing is brighter than its threshold {:g}; the brightest value is {:.3g}",
                         composer.desc(composer.entry(*place))->name, *threshold, brightest));
}

}  // namespace

void tell_of_dim_bloom(darkroom::Device& device, const darkroom::Composer& composer, const darkroom::Look& look,
                       const darkroom::DevelopDesc& desc, const darkroom::DevelopInput& input) {
    tell(device, composer, look, desc, input, input.time, input.camera);
}

void tell_of_dim_bloom(darkroom::Device& device, const darkroom::Composer& composer, const darkroom::Look& look,
                       const darkroom::DevelopDesc& desc, darkroom::DeviceFrame input) {
    input.record_before = {};
    tell(device, composer, look, desc, input, input.frame.time, input.frame.camera);
}

}  // namespace app
