// SPDX-License-Identifier: MIT
#pragma once
// A planned stack on a device, for frames up to an extent: images, descriptor sets and a ring of blocks around the
// kernels of a StackProgram. Made when a stack is compiled, on any thread; record() only writes into what is there.

#include <darkroom/composer.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compose/chain/frame_check.hpp"
#include "compose/chain/value_copies.hpp"
#include "compose/stack/stack_program.hpp"
#include "compose/worker.hpp"
#include "gpu/resource/resources.hpp"
#include "graph/physical/physical.hpp"
#include "plan/frame/frame_shape.hpp"

namespace darkroom::compose {

struct ChainDesc {
    std::shared_ptr<StackProgram> program;
    std::shared_ptr<const StackProgram> older{};  ///< the program before, while this is made; may be null
    Clock* clock = nullptr;                       ///< of the composer
    CompileDesc compile;
    std::uint32_t slots = 1;        ///< recordings that may be unfinished
    std::uint32_t max_threads = 0;  ///< that build kernels; 0: one a processor
    bool has_timers = false;
    /// The live entries in the program's order: their present values are what a recording uses.
    std::vector<std::shared_ptr<const plan::Entry>> entries;
};

class Chain final : public Garbage {
  public:
    /// `values` are copies of the entries: the live ones may change meanwhile.
    [[nodiscard]] static Result<std::unique_ptr<Chain>> create(gpu::Context& context, Worker& worker,
                                                               graph::HistoryPool& histories, ChainDesc desc,
                                                               std::span<const plan::Entry> values);

    /// Allocates nothing and waits for nothing. On error nothing is recorded.
    [[nodiscard]] Result<> record(VkCommandBuffer commands, const Frame& frame);
    /// Are its images in the formats, and no larger than the extents, that this was compiled for?
    [[nodiscard]] bool fits(const Frame& frame, const CompileDesc& before) const {
        return compose::fits(program_of(), desc_.compile, frame, before);
    }
    /// Takes back the last recording. False: there is none, or it was taken back.
    bool abandon();
    /// Builds the lean kernels of the present values on the calling thread, which is the one that records.
    [[nodiscard]] Result<> build_lean();
    /// With the values of the last recording; before there is one, with those of the compile.
    [[nodiscard]] const Plan& plan();
    [[nodiscard]] const CompileDesc& compiled_for() const { return desc_.compile; }
    [[nodiscard]] const std::shared_ptr<StackProgram>& program() const { return desc_.program; }
    [[nodiscard]] std::uint32_t slots() const { return desc_.slots; }
    /// Where the plan has the entry of this id.
    [[nodiscard]] std::optional<std::uint32_t> index_of(std::uint32_t entry_id) const;
    [[nodiscard]] RecordingTimes times();
    [[nodiscard]] ValueReading value(std::string_view name, std::uint32_t view) const;
    /// Of the last recording.
    [[nodiscard]] WatchState watch_state(std::uint32_t id) const;

  private:
    Chain(gpu::Context& context, Worker& worker, ChainDesc desc);
    [[nodiscard]] const plan::Program& program_of() const { return desc_.program->program; }
    [[nodiscard]] Result<> make_kernels(std::span<const plan::Entry> values);
    [[nodiscard]] Result<> make_resources(graph::HistoryPool& histories);
    [[nodiscard]] Result<> make_sets();
    [[nodiscard]] Result<> make_timers();
    [[nodiscard]] const ImageRef& image_of(const Frame& frame, plan::HostImage which) const;
    void write_frame_block(const Frame& frame);
    void lend_images(const Frame& frame);
    void leave_unused(VkCommandBuffer commands, const Frame& frame) const;
    void find_watched(const Frame& frame);
    void note_watch_states();
    [[nodiscard]] gpu::Region watched_region(const gpu::Region& whole, const Watched& watched, VkExtent2D extent) const;
    [[nodiscard]] bool is_jump(const Frame& frame);
    void find_histories(const Frame& frame);
    /// Of the passes that the graph kept, in a whole frame with these values.
    [[nodiscard]] std::vector<plan::Shape> expected_shapes(std::span<const plan::Entry* const> entries) const;
    [[nodiscard]] gpu::Binding bind(const plan::PassInput& input, const Frame& frame) const;
    [[nodiscard]] gpu::Binding bind_slot(std::uint32_t slot, std::uint32_t mip_level, const Frame& frame) const;
    [[nodiscard]] std::span<const std::uint32_t> write_words(const plan::ProgramPass& pass);
    [[nodiscard]] const gpu::Kernel& kernel_of(std::uint32_t pass, const gpu::Region& output,
                                               std::span<const gpu::Binding> inputs);
    [[nodiscard]] VkDescriptorSet updated_set(std::uint32_t pass, const gpu::Kernel& kernel,
                                              std::span<const gpu::Binding> inputs,
                                              std::span<const gpu::Binding> outputs,
                                              std::span<const gpu::Kernel::Block> buffers);
    /// Fills the custom vectors of a pass, for one that writes an image of this extent.
    void fill_custom(const plan::ProgramPass& pass, const PassContext& context, VkExtent2D output);
    /// Writes a pass's block and descriptors: all that may fail, before there is any command.
    void prepare_pass(std::uint32_t pass, const Frame& frame, const PassContext& context);
    void record_pass(VkCommandBuffer commands, std::uint32_t pass);
    /// True: what was recorded in the slot has finished, and its times are in times_.
    bool read_times(std::uint32_t slot);
    void record_value_copies(VkCommandBuffer commands, const Frame& frame);

    gpu::Context& context_;
    Worker& worker_;
    ChainDesc desc_;
    Plan plan_;
    std::vector<std::uint32_t> described_;     ///< gates and values of plan_; empty: those of the compile
    std::vector<const plan::Entry*> entries_;  ///< those of desc_, to be read
    std::uint64_t recordings_ = 0;
    bool is_abandonable_ = false;

    std::optional<graph::Compiled> compiled_;
    std::optional<graph::Schedule> schedule_;
    std::optional<graph::Physical> physical_;
    std::vector<std::uint32_t> declared_pass_;  ///< kept pass -> pass of the program; their number: copies values

    ValueCopies value_copies_;
    gpu::Buffer blocks_;  ///< for each slot the frame's block, then one a pass
    VkDeviceSize slot_stride_ = 0;
    std::vector<VkDeviceSize> block_at_;  ///< per pass: of its block, in a slot
    gpu::Timers timers_;

    /// A pass's sets, one a slot, and what was last written to them: images, then outputs.
    struct Written {
        VkImageView view = VK_NULL_HANDLE;
        VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
        bool is_nearest = false;
        friend bool operator==(const Written&, const Written&) = default;
    };
    struct Sets {
        std::uint32_t first = ~0u;  ///< of the pool
        std::uint32_t first_written = 0;
        std::uint32_t images = 0;
    };
    std::vector<std::uint8_t> is_nearest_;  ///< per slot: its format cannot be filtered
    gpu::DescriptorSets sets_;
    std::vector<Sets> pass_sets_;
    std::vector<Written> written_;

    // Scratch of a recording, sized at compile.
    struct Prepared {
        const gpu::Kernel* kernel = nullptr;
        VkDescriptorSet set = VK_NULL_HANDLE;
        std::array<gpu::Binding, gpu::max_outputs> outputs;
        std::size_t output_count = 0;
        VkExtent2D extent{};
    };
    std::vector<Prepared> prepared_;  ///< per pass
    plan::FrameValues values_;
    std::vector<plan::Shape> last_shapes_;  ///< per pass
    std::vector<graph::ImportState> import_states_;
    std::vector<PassVector> custom_;
    std::vector<std::uint32_t> words_;
    std::uint32_t slot_ = 0;
    std::uint32_t view_index_ = 0;           ///< of the last recording
    std::vector<std::uint8_t> has_history_;  ///< per entry, in the present recording
    // Per watch: what the present frame wants of it, or null; and what came of that.
    std::vector<const Watched*> watched_;
    std::vector<WatchState> watch_states_;

    // Timers: what was recorded in each slot.
    struct Timed {
        std::uint64_t frame_index = 0;
        std::vector<std::uint32_t> passes;
    };
    std::vector<Timed> timed_;
    std::vector<double> milliseconds_;
    std::vector<PassTime> times_;
    std::uint64_t times_frame_ = 0;
};

}  // namespace darkroom::compose
