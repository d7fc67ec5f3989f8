// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <darkroom/composer.hpp>
#include <darkroom/custom_effect.hpp>
#include <utility>

#include "core/caught.hpp"
#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "custom/description.hpp"

namespace darkroom {

struct CustomEffect::State : custom::Description {};

CustomEffect::CustomEffect(std::shared_ptr<const State> state) : state_(std::move(state)) {}
CustomEffect::CustomEffect(CustomEffect&&) noexcept = default;
CustomEffect& CustomEffect::operator=(CustomEffect&&) noexcept = default;
CustomEffect::~CustomEffect() = default;

const EffectInfo& CustomEffect::info() const { return state_->info; }

Result<CustomEffect> CustomEffect::parse(std::string_view text, std::string_view shown_name) try {
    if (text.size() > max_bytes)
        return user_error(fmt::format("{}: {} bytes, the file of an effect has at most {}", printable(shown_name),
                                      text.size(), max_bytes));
    auto state = std::make_shared<State>();
    DARKROOM_TRY(custom::read_description(*state, text, shown_name));
    state->info.owner = state;
    // Whoever calls these holds the state: they are members of what it keeps.
    const State* const own = state.get();
    state->info.build = [own](PassBuilder& builder) { custom::build(builder, *own); };
    if (own->pre_roll) state->info.pre_roll = [frames = *own->pre_roll](const void*, double) { return frames; };
    return CustomEffect(std::move(state));
} catch (...) {
    return caught("reading an effect");
}

Result<CustomEffect> CustomEffect::load(const std::string& file) try {
    DARKROOM_TRY_VALUE(auto bytes, read_file(file, {.max_size = max_bytes}));
    return parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
} catch (...) {
    return caught("reading an effect");
}

namespace {

/// docs/embedding.md quotes how it is used.
[[maybe_unused]] void usage_custom_effect(Composer& composer, void (*report)(const Error&)) {
    const auto duotone = darkroom::CustomEffect::load("duotone.glsl");
    if (!duotone) return report(duotone.error());
    const darkroom::Handle toned = composer.add(duotone->info(), nullptr);  // null: the defaults
    if (const auto set = composer.set(toned, "amount", 0.6); !set) return report(set.error());
}

}  // namespace

}  // namespace darkroom
