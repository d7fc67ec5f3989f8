// SPDX-License-Identifier: MIT
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/anamorphic_streaks.hpp>

#include <vector>

#include "anamorphic_streaks/anamorphic_streaks_reference.hpp"

namespace darkroom {

namespace {

constexpr auto anamorphic_streaks_rows = describe(
    field<&AnamorphicStreaks::intensity>("Amount of the streaks added to the picture.", {0, 64}).as_amount(),
    field<&AnamorphicStreaks::threshold>("Light above this value makes streaks.", {0, 65504}),
    field<&AnamorphicStreaks::length>("Distance at which a streak has fallen to 1/e, in a picture of 1080 lines.",
                                      {8, 512, Scale::Log}, unit::pixels),
    field<&AnamorphicStreaks::tint>("Colour that multiplies the streaks.", {0, 4}));

const AnamorphicStreaks& streaks_of(const void* parameters) {
    return *static_cast<const AnamorphicStreaks*>(parameters);
}

void bright_constants(const void* parameters, const PassContext&, std::span<PassVector> out) {
    out[0] = {streaks_of(parameters).threshold, 0, 0, 0};
}

template <std::uint32_t step>
void line_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const double decay = anamorphic_streaks_decay(streaks_of(parameters), context.frame_extent.width,
                                                  context.frame_extent.height, context.output_extent.width);
    const auto weights = anamorphic_streaks_weights(decay, step);
    for (std::size_t i = 0; i < 4; ++i) out[0][i] = static_cast<float>(weights[i]);
    // Both sides hold the light, so it counts once less; all together is 1.
    const double side = anamorphic_streaks_side(decay), both = 2 * side - 1;
    out[1] = {static_cast<float>(1U << 2 * step), static_cast<float>(side / both), static_cast<float>(1 / both), 0};
}

void build(PassBuilder& builder) {
    const std::uint32_t part = builder.from_max_extent(bright_part);
    const auto image = [&](const std::string& name) { return builder.create({.name = name, .denominator = part}); };
    const PassImage light = add_bright_light(builder, builder.source(), part, bright_constants);
    PassImage right = light, left = light;
    const auto inputs = [&] {
        return std::vector<KernelPassDesc::Input>{{.name = "anamorphic_streaks_right", .image = right},
                                                  {.name = "anamorphic_streaks_left", .image = left}};
    };
    constexpr std::array<ConstantsFunction, anamorphic_streaks_steps - 1> constants{
        line_constants<0>, line_constants<1>, line_constants<2>};
    for (std::size_t step = 0; step < constants.size(); ++step) {
        const std::string number = std::to_string(step + 1);
        const std::vector<PassImage> sides = builder.add_all({.name = "line " + number,
                                                              .shader = "anamorphic_streaks.glsl#line",
                                                              .inputs = inputs(),
                                                              .output = image("right " + number),
                                                              .more_outputs = {image("left " + number)},
                                                              .custom_vectors = 2,
                                                              .constants = constants[step]});
        if (sides.size() < 2) return;
        right = sides[0];
        left = sides[1];
    }
    KernelPassDesc join{.name = "join",
                        .shader = "anamorphic_streaks.glsl#join",
                        .inputs = inputs(),
                        .output = image("drawn"),
                        .custom_vectors = 2,
                        .constants = line_constants<anamorphic_streaks_steps - 1>};
    // Not in the call: g++ 12 warns of its move.
    const KernelPassDesc::Input own{.name = "anamorphic_streaks_light", .image = light};
    join.inputs.push_back(own);
    builder.side("anamorphic_streaks_drawn", builder.add(join), {0, 0, 0, 0});
}

}  // namespace

const EffectInfo& effect_info(const AnamorphicStreaks&) {
    static const EffectInfo info{
        .name = "anamorphic_streaks",
        .doc = "Draws lines of light across the picture from bright parts.",
        .parameters = anamorphic_streaks_rows.table(),
        .files = embedded_files("anamorphic_streaks"),
        .touch = Touch::Pointwise,
        .accepts = Domains::only(Domain::SceneLinear),
        .flat = {.documented = 61, .scene_linear = 65},
        .build = build,
        .reference = anamorphic_streaks_reference,
        .is_identity = [](const void* parameters) { return streaks_of(parameters).intensity == 0.0f; },
        .threshold = [](const void* parameters) -> std::optional<float> {
            const AnamorphicStreaks& streaks = streaks_of(parameters);
            if (streaks.intensity == 0.0f) return {};
            return streaks.threshold;
        },
    };
    return info;
}

}  // namespace darkroom
