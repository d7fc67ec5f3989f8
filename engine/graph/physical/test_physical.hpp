// SPDX-License-Identifier: MIT
#pragma once
// For tests only: runs the passes of a graph on the device, as compute kernels that add up, texel by texel, what they
// read, so that values show what went where. A pass that reads nothing, or whose name begins with "add", adds a value
// of the frame.

#include <memory>
#include <optional>

#include "gpu/test_run.hpp"
#include "graph/physical/physical.hpp"
#include "graph/test_graphs.hpp"

namespace darkroom::graph::test {

inline constexpr VkFormat float_format = VK_FORMAT_R32G32B32A32_SFLOAT;

inline ImageDesc float_image(std::string name, Size size = {}) {
    return {.name = std::move(name), .format = float_format, .size = size};
}

/// A compiled graph with what it takes to record it. `declare` fills the graph.
class Runner {
  public:
    template <class Declare>
    Runner(VkExtent2D largest, std::uint32_t views, HistoryPool& pool, const Declare& declare) {
        using gpu::test::must;
        declare(graph_);
        compiled.emplace(must(graph_.compile(largest, measure_on(context_))));
        schedule.emplace(*compiled);
        physical = must(Physical::create(context_, *compiled, views, pool));
        std::vector<VkDescriptorSetLayout> layouts;
        for (const PassDesc& pass : compiled->passes()) {
            gpu::KernelSpec spec{.name = pass.name, .outputs = {float_format}, .custom_vectors = 1};
            std::string sum = "custom[0]";
            for (std::size_t i = 0; i < pass.reads.size(); ++i) {
                spec.images.push_back({.name = fmt::format("image{}", i)});
                sum += fmt::format(" + load(image{}, pixel.texel)", i);
            }
            spec.body = fmt::format("vec4 shade(Pixel pixel) {{ return {}; }}\n", sum);
            kernels_.push_back(must(gpu::Kernel::create(context_, spec, gpu::Stage::Compute)));
            layouts.push_back(kernels_.back()->set_layout());
            blocks_.push_back(must(gpu::Buffer::create(context_, gpu::own_block_size(spec), gpu::block_usage,
                                                       gpu::Memory::Kind::Upload, "test block")));
        }
        sets_ = must(gpu::DescriptorSets::create(context_, layouts));
    }

    /// One frame; waits for it. `lent`: one an import, in the layout it has before and after.
    void frame(std::span<gpu::test::Picture* const> lent, std::uint32_t view, VkExtent2D extent, float value,
               std::span<const bool> gates = {}) {
        std::vector<ImportState> imports;
        for (std::uint32_t i = 0; i < lent.size(); ++i) {
            const gpu::Image& image = lent[i]->image;
            imports.push_back({.layout = lent[i]->layout, .final_layout = lent[i]->layout});
            physical.bind(i, {.handle = image.handle, .view = image.view, .mip_views = image.mip_views});
        }
        gpu::test::must(gpu::submit_and_wait(context_, "a test frame", [&](VkCommandBuffer commands) {
            physical.prepare(extent, true, view);
            schedule->derive(gates, imports, physical.frame(view));
            physical.begin(commands, context_.vk, *schedule, view);
            const auto checked = check(*compiled, *schedule, imports);
            EXPECT_TRUE(checked) << checked.error().text;
            for (const Step& step : schedule->steps()) {
                physical.record_barriers(commands, context_.vk,
                                         schedule->barriers().subspan(step.first_barrier, step.barrier_count), view);
                record_pass(commands, step.pass, view, extent, value);
            }
            physical.record_barriers(commands, context_.vk, schedule->final_barriers(), view);
            physical.end(*schedule, view);
        }));
    }

    std::optional<Compiled> compiled;
    std::optional<Schedule> schedule;
    Physical physical;

  private:
    [[nodiscard]] gpu::Binding bind(std::uint32_t slot, std::uint32_t view, VkExtent2D extent) const {
        return {.view = physical.mip_view(slot, 0, view),
                .region = {{}, compiled->slots()[slot].desc.size.of(extent), physical.extent(slot)},
                .is_nearest = true,
                .layout = schedule->read_layout(slot)};
    }

    void record_pass(VkCommandBuffer commands, std::uint32_t index, std::uint32_t view, VkExtent2D extent,
                     float value) const {
        const PassDesc& pass = compiled->passes()[index];
        std::vector<gpu::Binding> images;
        for (const Read& read : pass.reads)
            images.push_back(bind(schedule->slot_of(read.version, read.instead), view, extent));
        const gpu::Binding output = bind(schedule->slot_of(compiled->made(index)[0]), view, extent);
        const float added = pass.reads.empty() || pass.name.starts_with("add") ? value : 0.0F;
        const std::array<std::array<float, 4>, 1> custom{{{added, added, added, added}}};
        const gpu::KernelSpec& spec = kernels_[index]->spec();
        const std::size_t size = gpu::own_block_size(spec);
        gpu::write_own_block(spec, output.region, images, custom, {}, {blocks_[index].memory.mapped, size});
        kernels_[index]->write_set({.set = sets_.sets[index],
                                    .own = {blocks_[index].handle, 0, size},
                                    .images = images,
                                    .outputs = {&output, 1}});
        kernels_[index]->record(commands, sets_.sets[index], {&output, 1});
    }

    gpu::Context& context_ = gpu::test::context();
    Graph graph_;
    std::vector<std::unique_ptr<gpu::Kernel>> kernels_;
    std::vector<gpu::Buffer> blocks_;
    gpu::DescriptorSets sets_;
};

}  // namespace darkroom::graph::test
