// SPDX-License-Identifier: MIT
// Plans of any stack: bytes choose effects, values, wires and frames. Fused or
// not, a stack is refused or planned alike, and images that are alive at the
// same time share no byte.

#include <fmt/format.h>

#include <algorithm>
#include <darkroom/composer.hpp>
#include <darkroom/effect.hpp>
#include <set>

#include "fuzz/bytes.hpp"
#include "fuzz/target.hpp"

namespace darkroom::fuzz::plan_fuzz {
namespace {

constexpr std::size_t max_entries = 5;

Handle handle(Bytes& bytes, const Composer& composer) {
    const std::uint32_t pick = bytes.below(composer.size() + 4);
    if (pick < 4) return std::array{Handle{}, scene_color, scene_alpha, ui_layer}[pick];
    const Handle entry = composer.entry(pick - 4);
    return bytes.below(4) == 0 ? entry.previous() : entry;
}

void set_value(Bytes& bytes, Composer& composer, Handle entry, const ParamInfo& row) {
    std::array<std::uint32_t, 4> words{};
    if (row.words > words.size() || row.kind == Kind::Resource) return;
    for (std::uint32_t& word : std::span(words).first(row.words)) {
        const double share = bytes.below(256) / 255.0;
        const double value = row.range.min + share * (row.range.max - row.range.min);
        word = std::bit_cast<std::uint32_t>(static_cast<float>(value));
        if (row.kind == Kind::Int) word = static_cast<std::uint32_t>(static_cast<std::int32_t>(value));
        if (row.kind == Kind::Toggle) word = share < 0.5 ? 0 : 1;
        if (row.kind == Kind::Choice)
            word = static_cast<std::uint32_t>(share * 255 + 0.5) % static_cast<std::uint32_t>(row.choices.size());
    }
    (void)composer.set(entry, row.name, std::span(words).first(row.words));
}

void fill(Bytes& bytes, Composer& composer) {
    while (!bytes.is_empty() && composer.size() < max_entries) {
        const EffectInfo& info = *all_effects()[bytes.below(all_effects().size())];
        const std::uint32_t flags = bytes.below(256);
        EntryDesc desc{.is_ui = (flags & 1) != 0 && info.flat.is_of_ui(), .enabled = (flags & 2) == 0};
        if ((flags & 4) != 0) desc.input = handle(bytes, composer);
        if ((flags & 8) != 0) desc.source = handle(bytes, composer);
        if ((flags & 16) != 0 || info.has_second()) desc.second = handle(bytes, composer);
        if ((flags & 32) != 0) desc.mask = handle(bytes, composer);
        if ((flags & 64) != 0)
            desc.opacity = static_cast<float>(bytes.below(3)) / 2, desc.blend = BlendMode(bytes.below(9));
        if ((flags & 128) != 0) {
            desc.scale = {1 + bytes.below(2), 1 + bytes.below(3)};
            desc.format = std::array{VK_FORMAT_UNDEFINED, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT,
                                     VK_FORMAT_R8_UNORM}[bytes.below(4)];
        }
        const Handle entry = composer.add(info, nullptr, desc);
        const std::span<const ParamInfo> rows = info.parameters.rows;
        for (std::uint32_t values = bytes.below(4); values > 0 && !rows.empty(); --values)
            set_value(bytes, composer, entry, rows[bytes.below(rows.size())]);
    }
}

CompileDesc frames(Bytes& bytes) {
    const std::uint32_t flags = bytes.below(256);
    CompileDesc desc{.max_extent = {1 + bytes.below(200), 1 + bytes.below(200)}};
    if ((flags & 1) != 0) desc.depth = {VK_FORMAT_D32_SFLOAT}, desc.is_depth_planar = (flags & 2) != 0;
    if ((flags & 4) != 0) desc.normals = {VK_FORMAT_R16G16B16A16_SFLOAT};
    if ((flags & 8) != 0) desc.velocity = {VK_FORMAT_R16G16_SFLOAT}, desc.is_velocity_plain = (flags & 2) != 0;
    if ((flags & 16) != 0) desc.ui = {VK_FORMAT_R8G8B8A8_UNORM};
    desc.has_shadows = (flags & 32) != 0;
    if ((flags & 64) != 0) desc.target.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    if ((flags & 128) != 0) desc.target_extent = {1 + bytes.below(200), 1 + bytes.below(200)};
    desc.kernels = std::array{KernelStage::Auto, KernelStage::Compute, KernelStage::Raster}[bytes.below(3)];
    return desc;
}

std::string wrong_use(const Plan& plan, const PlanPass& pass, const PlanUse& use) {
    if (use.image >= plan.images.size()) return fmt::format("{} uses image {}", pass.name, use.image);
    const PlanImage& image = plan.images[use.image];
    if (use.mip_level >= image.mip_levels)
        return fmt::format("{} uses a mip level that {} lacks", pass.name, image.name);
    const auto number = static_cast<std::uint32_t>(&pass - plan.passes.data());
    if (number < image.first_pass || number > image.last_pass)
        return fmt::format("{} uses {} outside of its life", pass.name, image.name);
    return {};
}

std::string wrong_images(const Plan& plan) {
    std::set<std::string_view> names;
    for (const PlanImage& a : plan.images) {
        if (!names.insert(a.name).second) return fmt::format("two images are {}", a.name);
        if (a.kind != PlanImage::Kind::Transient || a.first_pass == PlanImage::never) continue;
        if (a.offset + a.bytes > plan.transient_bytes) return fmt::format("{} lies outside of the memory", a.name);
        for (const PlanImage& b : plan.images) {
            if (&a == &b || b.kind != PlanImage::Kind::Transient || b.first_pass == PlanImage::never) continue;
            if (a.first_pass <= b.last_pass && b.first_pass <= a.last_pass && a.offset < b.offset + b.bytes &&
                b.offset < a.offset + a.bytes)
                return fmt::format("{} and {} share bytes while both live", a.name, b.name);
        }
    }
    return {};
}

std::string wrong_plan(const Plan& plan) {
    for (const PlanPass& pass : plan.passes) {
        for (const PlanUse& use : pass.reads)
            if (std::string wrong = wrong_use(plan, pass, use); !wrong.empty()) return wrong;
        for (const PlanUse& use : pass.more_writes)
            if (std::string wrong = wrong_use(plan, pass, use); !wrong.empty()) return wrong;
        if (pass.writes.image != PlanImage::never)
            if (std::string wrong = wrong_use(plan, pass, pass.writes); !wrong.empty()) return wrong;
    }
    return plan.text().empty() || plan.json().empty() ? "a plan has no text" : wrong_images(plan);
}

std::string run(std::string_view input) {
    Bytes bytes(input);
    CompileDesc desc = frames(bytes);
    Composer composer(Device::assumed());
    fill(bytes, composer);
    const Result<Plan> fused = composer.plan(desc);
    desc.fuse = false;
    const Result<Plan> unfused = composer.plan(desc);
    if (fused.has_value() != unfused.has_value())
        return fmt::format("fused and not: {}", fused ? unfused.error().text : fused.error().text);
    if (!fused) return wrong_error(fused.error());
    for (const Plan* const plan : {&*fused, &*unfused})
        if (std::string wrong = wrong_plan(*plan); !wrong.empty()) return wrong + "\n" + plan->text();
    const auto is_same = [](const PlanState& a, const PlanState& b) {
        return a.entry == b.entry && a.state == b.state;
    };
    if (fused->left_out != unfused->left_out || !std::ranges::equal(fused->states, unfused->states, is_same))
        return fmt::format("fused\n{}\nand not\n{}", fused->text(), unfused->text());
    return {};
}

std::vector<std::string> seeds() {
    std::vector<std::string> out;
    std::mt19937 random(1);
    for (int i = 0; i < 40; ++i) {
        std::string& seed = out.emplace_back();
        for (int k = 0; k < 8 + 4 * i; ++k) seed += static_cast<char>(random());
    }
    return out;
}

const Registration plan({.name = "plan", .run = run, .seeds = seeds, .longest = 256});

}  // namespace
}  // namespace darkroom::fuzz::plan_fuzz
