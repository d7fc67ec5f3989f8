// SPDX-License-Identifier: MIT
#pragma once
// A compiled stack on a device: kernels, images, descriptor sets and the constants ring of one Program. Made by
// Composer::compile; record() only writes into what is there.

#include <darkroom/composer.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compose/tables.hpp"
#include "compose/variants.hpp"
#include "gpu/resources.hpp"
#include "graph/physical.hpp"
#include "plan/gates.hpp"
#include "plan/program.hpp"

namespace darkroom::compose {

using namespace plan;

class Chain {
  public:
    [[nodiscard]] static Result<std::unique_ptr<Chain>> create(gpu::Context& context, Program program,
                                                               const CompileDesc& desc, std::uint32_t slots,
                                                               bool has_timers, std::span<const Entry> stack);
    ~Chain();

    /// Allocates nothing and waits for nothing. On error nothing is recorded.
    [[nodiscard]] Result<> record(VkCommandBuffer commands, const Frame& frame, std::span<const Entry> stack);
    /// Builds the lean kernels of the present toggles on the calling thread.
    [[nodiscard]] Result<> build_lean(std::span<const Entry> stack);
    /// Recordings of it may be unfinished, but there will be no more: ends its thread.
    void retire() { builders_.reset(); }
    [[nodiscard]] Plan describe(std::span<const Entry> stack) const;
    [[nodiscard]] const Program& program() const { return program_; }
    /// Times of the last finished recording.
    [[nodiscard]] std::span<const PassTime> times();

  private:
    Chain(gpu::Context& context, Program program, const CompileDesc& desc, std::uint32_t slots);
    [[nodiscard]] Result<> make_kernels(std::span<const Entry> stack);
    [[nodiscard]] Result<> make_resources(bool has_timers);
    [[nodiscard]] const ImageRef& image_of(const Frame& frame, HostImage which) const;
    void reset_histories(const Frame& frame);
    [[nodiscard]] Domain domain_behind(std::uint32_t entry) const {
        return entry == no_entry ? Domain::SceneLinear : domains_[entry];
    }
    void evaluate(std::span<const Entry> stack, const PassContext& context);
    [[nodiscard]] Shape shape_of(const ProgramPass& pass, std::span<const Entry> stack, const gpu::Region& output,
                                 std::span<const gpu::Binding> inputs) const;
    [[nodiscard]] Shape expected_shape(const ProgramPass& pass, std::span<const Entry> stack) const;
    [[nodiscard]] gpu::Binding bind(const PassInput& input, const Frame& frame, VkExtent2D extent) const;
    [[nodiscard]] gpu::Binding bind_slot(std::uint32_t slot, std::uint32_t mip_level, const Frame& frame,
                                         VkExtent2D extent) const;
    void record_pass(VkCommandBuffer commands, std::uint32_t pass, const Frame& frame, const PassContext& context,
                     std::span<const Entry> stack);

    gpu::Context& context_;
    Program program_;
    CompileDesc desc_;
    std::uint32_t slots_ = 1;
    std::uint64_t recordings_ = 0;

    std::optional<graph::Compiled> compiled_;
    std::optional<graph::Schedule> schedule_;
    std::optional<graph::Physical> physical_;
    std::vector<bool> is_nearest_;              ///< per slot: its format is not filtered
    std::vector<std::uint32_t> declared_pass_;  ///< kept pass -> pass of the program

    std::vector<Shape> last_shapes_;                   ///< per pass: of its last recording
    std::vector<std::unique_ptr<Variants>> variants_;  ///< per pass of the program; null where the graph culled it
    std::unique_ptr<Builders> builders_;
    gpu::DescriptorSets sets_;
    std::vector<std::uint32_t> set_at_;  ///< per pass: index of its first set, then one a slot
    gpu::Buffer constants_, pass_blocks_;
    VkDeviceSize constants_stride_ = 0, pass_block_stride_ = 0;
    Tables tables_;
    LitShadowMap lit_;
    gpu::Timers timers_;

    // Scratch of a recording, sized at compile.
    Gates gates_;
    Finish finish_ = Finish::None;
    std::vector<graph::ImportState> import_states_;
    std::vector<PassVector> custom_;
    std::uint32_t slot_ = 0;

    /// What the histories of a view were made from.
    struct View {
        std::vector<std::uint8_t> was_on;  ///< per entry with histories
    };
    std::vector<View> views_;

    // Timers: what was recorded in each slot.
    std::vector<std::vector<std::uint32_t>> timed_passes_;
    std::vector<double> milliseconds_;
    std::vector<PassTime> times_;
};

}  // namespace darkroom::compose
