// SPDX-License-Identifier: MIT
#pragma once
// The planner's working state, for planner*.cpp and builder.cpp only.

#include <darkroom/effect.hpp>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "plan/frame_inputs.hpp"
#include "plan/program.hpp"

namespace darkroom::plan {

class Builder;

/// Images of the graph's own are made for whatever passes do with them.
inline constexpr VkImageUsageFlags own_usage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;

/// Is it part of a reading?
[[nodiscard]] constexpr bool is_reading(Touch touch) { return touch == Touch::Map || touch == Touch::Tap; }

/// One text for equal sizes.
[[nodiscard]] std::string size_text(graph::Size size);

class Planner {
  public:
    Planner(std::span<const Entry> stack, const CompileDesc& desc, const PlannerTraits& traits);
    [[nodiscard]] Result<Program> run();

  private:
    friend class Builder;
    static constexpr std::size_t no_kernel = ~std::size_t{0};

    /// A picture on its way through the stack: an image, or the end of a kernel that is still open.
    struct Value {
        graph::Version image;
        std::size_t kernel = no_kernel;
        graph::Size size{};
        std::string why;     ///< of an image: why a new kernel starts from it
        std::string reader;  ///< of an open kernel: who else reads this picture, so that it must become an image
        std::size_t reading = no_reading;  ///< it is no more than this, so that maps may go on with it
    };
    static constexpr std::size_t no_reading = ~std::size_t{0};
    /// Maps and taps over an image. Whoever goes on with one takes its steps over.
    struct Reading {
        graph::Version image;
        graph::Size size{};
        std::vector<FusedStep> steps;  ///< without texts and places
    };
    struct OpenKernel {
        graph::Version picture;
        graph::Size size{};
        std::string boundary;
        Resampling resampling = Resampling::Linear;  ///< where the picture has another size
        ConstantsFunction constants = nullptr;       ///< of the resampling
        bool is_alpha = false;                       ///< makes a grey picture of the alpha before anything else
        FinishAlpha alpha{};                         ///< of the target's
        std::vector<FusedStep> steps;
        std::vector<std::pair<std::string, PassInput>> images;
        std::vector<std::pair<std::string, std::uint32_t>> values;  ///< buffers, by name
    };
    struct BufferRecord {
        graph::Version version;     ///< behind the passes so far
        std::uint32_t numbers = 0;  ///< of a value; 0: it is of this frame alone
    };
    struct Facts {
        std::uint32_t root = 0;  ///< the version that the image began as
        graph::Size size{};
        VkFormat format = VK_FORMAT_UNDEFINED;
        VkImageUsageFlags usage = 0;
        std::vector<graph::Version> fall_backs;
        std::string name;
        bool is_single = false;  ///< one texel that stands for all
    };

    [[nodiscard]] Result<> check_handles() const;
    /// Where the entry is in the stack; no_entry: it is not there.
    [[nodiscard]] std::uint32_t index_of(Handle handle) const;
    /// Does the wire name the output of an entry, of this frame?
    [[nodiscard]] bool is_of_entry(Handle handle) const;
    void leave_out();
    /// The entry whose output one in this place gets by default; no_entry: the scene, ui_entry: the interface's image.
    [[nodiscard]] std::uint32_t entry_before(std::uint32_t entry, bool is_ui) const;
    /// The same in the picture's chain, behind all entries.
    [[nodiscard]] std::uint32_t last_of_picture() const;
    /// The second picture of an entry, which may be the interface.
    [[nodiscard]] Handle second_of(std::uint32_t entry) const;
    /// Who gets what from whom, past the entries that are left out.
    void resolve_inputs();
    [[nodiscard]] std::uint32_t past_what_is_left_out(std::uint32_t entry) const;
    [[nodiscard]] std::uint32_t resolved(Handle handle, std::uint32_t entry) const;
    [[nodiscard]] std::size_t value_of(Handle handle, std::uint32_t entry) const;
    /// The picture that the host defined under this handle; null: the handle names something else.
    [[nodiscard]] const ResourceImage* picture_of(std::uint32_t entry, Handle handle) const;
    [[nodiscard]] Result<> make_wires();
    [[nodiscard]] Result<> previous_of(Handle handle);
    [[nodiscard]] Result<graph::Version> copy_into(std::size_t value, graph::Version image);
    [[nodiscard]] graph::Size output_size(std::uint32_t entry) const;
    /// What the frame is finished at, and the interface has.
    [[nodiscard]] graph::Size frame_output() const;
    /// Of the result of an effect of its own passes.
    [[nodiscard]] graph::Size result_size(const EffectInfo& info, graph::Size input) const;
    /// Is what an entry works at no larger than the device allows?
    [[nodiscard]] Result<> check_size(std::uint32_t entry, graph::Size size) const;
    [[nodiscard]] Result<std::size_t> scaled_input(std::uint32_t entry);
    [[nodiscard]] Result<> keep_output(std::uint32_t entry);
    void count_readers();
    [[nodiscard]] Result<std::size_t> add_entry(std::uint32_t entry, std::size_t input);
    [[nodiscard]] Result<std::size_t> add_result(std::uint32_t entry, std::size_t input, Builder& builder);
    [[nodiscard]] Result<std::size_t> append(std::uint32_t entry, std::size_t input, FusedStep step,
                                             std::vector<PassInput> sides, const Reading* second = nullptr);
    /// Where an entry joins picture and interface, the picture at the target's size, if all that follows is in its
    /// kernel.
    [[nodiscard]] Result<std::size_t> at_target_size(std::uint32_t entry, std::size_t input);
    /// Does any entry before this one encode?
    [[nodiscard]] bool may_be_encoded(std::uint32_t entry) const;
    /// Is its picture the interface, through nothing that makes another state of it?
    [[nodiscard]] bool is_of_ui(std::uint32_t entry) const;
    [[nodiscard]] std::size_t open_kernel(std::size_t input, std::string why);
    /// A map or a tap: goes on with the reading that its input is, or begins one.
    [[nodiscard]] Result<std::size_t> append_reading(std::uint32_t entry, std::size_t input, FusedStep step);
    /// Puts the steps of a reading into a kernel, where they read its image of this name.
    [[nodiscard]] Result<> add_steps(std::size_t kernel, const Reading& reading, std::string_view image);
    /// Gives a step its place in a kernel, and its text.
    [[nodiscard]] Result<> add_step(std::size_t kernel, FusedStep step);
    /// Makes the picture an image, if it is not one yet, by closing its kernel.
    [[nodiscard]] Result<graph::Version> materialise(std::size_t value, const std::string& why);
    [[nodiscard]] Result<graph::Version> materialise_into(std::size_t value, graph::Version image, bool is_always_on,
                                                          const std::string& why);
    /// An image of exactly this size for what is read by texel: resampled, if anything else may stand there.
    [[nodiscard]] Result<graph::Version> at_size(graph::Version version, graph::Size size, const std::string& name);
    /// An image of the host at an entry's size, where that is another one.
    [[nodiscard]] Result<graph::Version> input_at_size(const FrameInput& input, graph::Size size);
    [[nodiscard]] bool has_size(graph::Version version, graph::Size size) const;
    [[nodiscard]] Result<graph::Version> close_kernel(std::size_t kernel, graph::Version target, VkFormat format,
                                                      Finish finish, bool is_always_on);
    /// Reads images by sampling where the device has no more storage images for a kernel. Tables that are only loaded
    /// stay.
    void limit_storage_images(ProgramPass& pass) const;
    /// What filters and depth need of each image, literals, and what else holds of a pass of any kind.
    [[nodiscard]] Result<> settle_inputs(ProgramPass& pass);
    void add_reads(const ProgramPass& pass, graph::PassDesc& desc) const;
    void take_facts(graph::Version made, graph::Version from);
    /// Adds a compute pass, whose outputs are what they are before it.
    [[nodiscard]] Result<> add_compute(ProgramPass pass);
    /// Whether a linear sampler reads whatever may stand behind the input.
    [[nodiscard]] bool can_filter(const PassInput& input) const;
    [[nodiscard]] Result<graph::Version> add_pass(ProgramPass pass, graph::Version target, std::uint32_t mip_level,
                                                  std::span<const graph::Version> more_targets = {});
    /// One of a watch, or of what entries share: others do not join it because they look alike.
    [[nodiscard]] bool is_special_gate(std::size_t index) const;
    [[nodiscard]] std::int32_t toggle_index(Gate toggle);
    [[nodiscard]] graph::Version import_host(HostImage image, const std::string& name, const ImageUse& use,
                                             graph::Size size);
    [[nodiscard]] graph::Version import_input(const FrameInput& input);
    [[nodiscard]] graph::Version create_picture(const std::string& name, graph::Size size, VkFormat format);
    /// The name, or name#2 and so on where another image has it.
    [[nodiscard]] std::string own_name(const std::string& name);
    void fall_back(graph::Version version, graph::Version instead);
    [[nodiscard]] graph::Version import_neutral(VkFormat format, const PassVector& value);
    /// An image that never changes, as one of the graph's.
    [[nodiscard]] graph::Version import_constant(TableDesc desc, graph::Size size);
    /// An input that is not the picture: sampled, but for tables that are only loaded.
    [[nodiscard]] gpu::KernelImage kernel_image(std::string name, const PassInput& input) const;
    void collect_roots(graph::Version version, std::vector<std::uint32_t>& roots) const;
    [[nodiscard]] bool may_share(graph::Version a, graph::Version b) const;
    [[nodiscard]] VkFormat storage_format(graph::Version version) const;
    [[nodiscard]] Result<> finish();
    /// Adds the pass that copies them.
    void keep_values();
    /// Adds the passes that copy what is watched, as far as it has been made: outputs of entries up to this one, and
    /// images.
    [[nodiscard]] Result<> add_watches(std::uint32_t entry);
    /// What a watch reads, and the gate of the pass that makes it.
    struct WatchedImage {
        PassInput input;
        std::int32_t writer = -1;
    };
    /// None: it has not been made.
    [[nodiscard]] Result<std::optional<WatchedImage>> watched_output(std::uint32_t watch, std::uint32_t entry);
    [[nodiscard]] std::optional<WatchedImage> watched_image(const Watch& watch);
    [[nodiscard]] Result<> add_watch(std::uint32_t watch, const WatchedImage& image);
    void remark_watches();
    /// Kept for the passes that share it.
    [[nodiscard]] Result<std::shared_ptr<const EffectText>> text_of(const EffectInfo& info, const std::string& file,
                                                                    std::uint32_t place,
                                                                    std::span<const std::string> images);

    std::span<const Entry> stack_;
    const CompileDesc& desc_;
    const PlannerTraits& traits_;
    Domain target_domain_ = Domain::Encoded;
    Program program_;
    std::vector<Value> values_;                                    ///< 0: the scene colour
    std::vector<std::size_t> entry_values_;                        ///< per entry: the value it makes
    std::map<std::pair<std::uint32_t, bool>, std::size_t> wires_;  ///< by handle: values that no entry makes
    std::map<std::uint32_t, graph::Version> kept_outputs_;  ///< by entry: where its output lies for the next frame
    std::vector<std::string> image_reader_;                 ///< per entry: who reads its output as an image
    std::vector<OpenKernel> kernels_;
    std::size_t joined_entries_ = 0;
    std::vector<Reading> readings_;
    std::map<std::uint32_t, Facts> facts_;  ///< by version
    std::set<std::string> image_names_;
    std::map<HostImage, graph::Version> host_images_;
    std::map<std::tuple<const EffectInfo*, std::string, std::uint32_t, std::vector<std::string>>,
             std::shared_ptr<const EffectText>>
        texts_;

    std::vector<BufferRecord> buffers_;
    std::map<std::string, std::uint32_t, std::less<>> named_values_;
    std::map<std::uint32_t, std::vector<std::pair<std::string, std::uint32_t>>> entry_values_read_;  ///< by entry
    std::map<std::pair<FrameImage, graph::Size>, graph::Version> resampled_;

    /// What several effects share, by name and the size of the picture at their place; its passes run while any of
    /// those that asked is on.
    struct Shared {
        graph::Version version, first_written;
        VkFormat format = VK_FORMAT_UNDEFINED;
        std::int32_t toggle = -1;
        std::vector<std::int32_t> needs{};  ///< toggles of the shared images that it is made from
    };
    std::map<std::string, Shared, std::less<>> shared_;
};

}  // namespace darkroom::plan
