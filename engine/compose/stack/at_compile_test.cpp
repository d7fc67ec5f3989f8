// SPDX-License-Identifier: MIT
// Rows that are read at compile: what an effect's passes depend on carries the flag, and nothing else does.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <darkroom/effects.hpp>
#include <functional>

#include "compose/stack/stack_program.hpp"
#include "gpu/device/assumed_device.hpp"
#include "plan/frame/shape.hpp"

namespace darkroom {
namespace {

using Words = std::vector<std::uint32_t>;

class ComposeAtCompile : public testing::Test {
  protected:
    /// Everything that a plan of this effect alone consists of.
    [[nodiscard]] std::string planned(const EffectInfo& info, const Words& words) const {
        plan::Entry entry{.id = 1, .info = &info, .desc = {}, .resources = resources_, .base = words, .overrides = {}};
        if (info.has_second()) entry.desc.second = scene_color;
        entry.desc.name = "entry";
        const CompileDesc desc{.max_extent = {640, 360},
                               .depth = {VK_FORMAT_D32_SFLOAT},
                               .target = {VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_STORAGE_BIT}};
        const auto made = compose::plan_stack(*context_, {&entry, 1}, desc);
        if (!made) {
            ADD_FAILURE() << info.name << ": " << made.error().text;
            return {};
        }
        const plan::Program& program = (*made)->program;
        std::string out;
        for (const plan::ProgramPass& pass : program.passes) {
            const auto spec = plan::complete_spec(pass);
            out += fmt::format("{} {}\n{}\n", pass.name, spec ? spec->custom_vectors : 0, spec ? spec->body : "");
            for (const VkFormat format : pass.spec.outputs) out += fmt::format("to {}\n", static_cast<int>(format));
        }
        for (const plan::FixedImage& image : program.fixed_images)
            out.append(reinterpret_cast<const char*>(image.desc.data.data()), image.desc.data.size());
        const auto compiled = program.graph.compile(
            desc.max_extent, [&](const graph::ImageDesc& image, VkImageUsageFlags, const graph::Extents& frame) {
                const VkExtent2D extent = image.size.of(frame);
                out += fmt::format("image of {}x{}\n", extent.width, extent.height);
                return graph::Requirements{.size = 4, .alignment = 4};
            });
        EXPECT_TRUE(compiled) << info.name;
        return out;
    }
    /// The words of `base` with other values of a row: each choice, both ends and what lies between, each resource.
    [[nodiscard]] static std::vector<Words> others(const ParamInfo& row, const Words& base) {
        std::vector<Words> out;
        const auto add = [&](std::uint32_t word) {
            out.push_back(base);
            std::fill_n(out.back().begin() + row.word, row.words, word);
        };
        if (row.kind == Kind::Curve) return out;
        if (row.kind == Kind::Choice || row.kind == Kind::Toggle || row.kind == Kind::Resource) {
            const std::size_t count = row.kind == Kind::Choice ? row.choices.size() : row.kind == Kind::Toggle ? 2 : 3;
            for (std::uint32_t i = 0; i < count; ++i) add(i);
            return out;
        }
        for (const double share : {0.0, 0.03, 0.3, 1.0}) {
            const double value = row.range.min + (row.range.max - row.range.min) * share;
            add(row.kind == Kind::Int ? static_cast<std::uint32_t>(static_cast<std::int32_t>(value))
                                      : std::bit_cast<std::uint32_t>(static_cast<float>(value)));
        }
        return out;
    }
    /// The defaults, and those with each other value of one row that is read at compile.
    [[nodiscard]] static std::vector<Words> bases(const EffectInfo& info) {
        const Words defaults(info.parameters.defaults.begin(), info.parameters.defaults.end());
        std::vector<Words> out{defaults};
        for (const ParamInfo& row : info.parameters.rows)
            if (row.is_at_compile)
                for (Words& other : others(row, defaults)) out.push_back(std::move(other));
        return out;
    }
    [[nodiscard]] bool changes_plan(const EffectInfo& info, const ParamInfo& row) const {
        for (const Words& base : bases(info)) {
            const std::string before = planned(info, base);
            for (const Words& other : others(row, base))
                if (planned(info, other) != before) return true;
        }
        return false;
    }

  private:
    std::shared_ptr<gpu::Context> context_ = gpu::assumed_context();
    std::shared_ptr<const Resources> resources_ = std::make_shared<Resources>(
        Resources{{1, std::make_shared<ResourceData>(ColorTable{.size = 2, .cube = std::vector<float>(24, 0.25f)})},
                  {2, std::make_shared<ResourceData>(ResourceImage{.width = 1, .height = 1, .rgba = {1, 0, 0, 1}})}});
};

TEST_F(ComposeAtCompile, ExactlyTheFlaggedRowsChangeThePlan) {
    std::size_t flagged = 0;
    for (const EffectInfo* const info : all_effects())
        for (const ParamInfo& row : info->parameters.rows) {
            EXPECT_EQ(changes_plan(*info, row), row.is_at_compile) << info->name << "." << row.name;
            flagged += row.is_at_compile ? 1 : 0;
        }
    EXPECT_GE(flagged, 10U);
}

}  // namespace
}  // namespace darkroom
