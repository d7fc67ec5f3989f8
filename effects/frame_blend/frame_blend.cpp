// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/describe.hpp>
#include <darkroom/effect.hpp>
#include <darkroom/effects/frame_blend.hpp>
#include <string>
#include <utility>

#include "frame_blend/frame_blend_reference.hpp"

namespace darkroom {

namespace {

constexpr auto frame_blend_rows =
    describe(field<&FrameBlend::amount>("Weight of all earlier frames together.", {0, 1}),
             field<&FrameBlend::frames>("Length of the trail, in steps of 1/60 s.", {1, 7}),
             field<&FrameBlend::area>("Share of the picture's area that each earlier frame is kept at.").at_compile());

constexpr std::array<const char*, frame_blend_slots> slot_names{"frame_blend_0", "frame_blend_1", "frame_blend_2",
                                                                "frame_blend_3", "frame_blend_4", "frame_blend_5",
                                                                "frame_blend_6", "frame_blend_7"};

const FrameBlend& blend_of(const void* parameters) { return *static_cast<const FrameBlend*>(parameters); }

std::int64_t floor_mod(std::int64_t a, std::int64_t b) { return (a % b + b) % b; }

template <std::int32_t slot>
void slot_constants(const void*, const PassContext& context, std::span<PassVector> out) {
    const FrameBlendRing ring(context.time, context.delta_time);
    out[0] = {ring.is_renewed(slot) ? 1.0f : 0.0f, 0, 0, 0};
}

void sum_constants(const void* parameters, const PassContext& context, std::span<PassVector> out) {
    const FrameBlend& blend = blend_of(parameters);
    const FrameBlendRing ring(context.time, context.delta_time);
    std::array<double, frame_blend_slots> weights{};
    double sum = 0;
    for (std::int32_t slot = 0; slot < frame_blend_slots; ++slot)
        sum += weights[static_cast<std::size_t>(slot)] = std::clamp(1 - (ring.age(slot) - 1) / blend.frames, 0.0, 1.0);
    // At very low rates a single frame is longer than the trail.
    const double scale = sum > 0 ? double{blend.amount} / sum : 0;
    for (std::size_t i = 0; i < weights.size(); ++i) out[i / 4][i % 4] = static_cast<float>(weights[i] * scale);
}

template <std::int32_t... slot>
std::vector<KernelPassDesc::Input> add_ring(PassBuilder& builder, PassImage small, std::uint32_t denominator,
                                            std::integer_sequence<std::int32_t, slot...>) {
    std::vector<KernelPassDesc::Input> ring;
    const auto add_slot = [&](std::int32_t number, ConstantsFunction constants) {
        const std::string name = "slot " + std::to_string(number);
        const PassBuilder::History history = builder.history({.name = name, .denominator = denominator});
        static_cast<void>(builder.add({.name = name,
                                       .shader = "frame_blend.glsl#slot",
                                       .inputs = {{.name = "frame_blend_small", .image = small},
                                                  {.name = "frame_blend_kept", .image = history.previous}},
                                       .output = history.current,
                                       .custom_vectors = 1,
                                       .constants = constants}));
        ring.push_back({.name = slot_names[static_cast<std::size_t>(number)], .image = history.previous});
    };
    (add_slot(slot, slot_constants<slot>), ...);
    return ring;
}

void build(PassBuilder& builder) {
    const std::uint32_t denominator = blend_of(builder.parameters()).area == FrameBlendArea::Quarter ? 2 : 4;
    const PassImage small = builder.add({.name = "reduce",
                                         .shader = "frame_blend.glsl#reduce",
                                         .inputs = {{.name = "frame_blend_picture", .image = builder.picture()}},
                                         .output = builder.create({.name = "small", .denominator = denominator})});
    std::vector<KernelPassDesc::Input> ring =
        add_ring(builder, small, denominator, std::make_integer_sequence<std::int32_t, frame_blend_slots>{});
    builder.side("frame_blend_past",
                 builder.add({.name = "sum",
                              .shader = "frame_blend.glsl#sum",
                              .inputs = std::move(ring),
                              .output = builder.create({.name = "past", .denominator = denominator}),
                              .custom_vectors = 2,
                              .constants = sum_constants}),
                 {});
}

/// The trail, and the frame that its last step falls into.
std::uint32_t pre_roll(const void* parameters, double delta_time) {
    const double frames = std::ceil((blend_of(parameters).frames + 1) / (60 * delta_time)) + 1;
    return static_cast<std::uint32_t>(std::min(frames, 1e9));
}

}  // namespace

FrameBlendRing::FrameBlendRing(double time, double delta_time) {
    const auto step = [](double at) { return at * 60 + 0.382; };
    now_ = step(time);
    last_ = static_cast<std::int64_t>(std::floor(now_));
    before_ = static_cast<std::int64_t>(std::floor(step(time - std::max(delta_time, 0.0))));
}

bool FrameBlendRing::is_renewed(std::int32_t slot) const {
    return floor_mod(last_ - slot, frame_blend_slots) < last_ - before_;
}

double FrameBlendRing::age(std::int32_t slot) const {
    return now_ - static_cast<double>(before_ - floor_mod(before_ - slot, frame_blend_slots));
}

const EffectInfo& effect_info(const FrameBlend&) {
    static const EffectInfo info{
        .name = "frame_blend",
        .doc = "Lays earlier frames, kept small, over the present one: trails with an end.",
        .parameters = frame_blend_rows.table(),
        .files = embedded_files("frame_blend"),
        .touch = Touch::Pointwise,
        .accepts = Domains::all(),
        .flat = {.documented = 44, .scene_linear = 46},
        .build = build,
        .reference = frame_blend_reference,
        .is_identity = [](const void* parameters) { return blend_of(parameters).amount == 0.0f; },
        .pre_roll = pre_roll,
    };
    return info;
}

}  // namespace darkroom
