// SPDX-License-Identifier: MIT
#pragma once
// The pipelines that a Composer made, noted while it made them, and made again without the library: what a start costs
// at least. Not a model of the library: no images, no descriptor sets, no graph.

#include <filesystem>
#include <string>
#include <vector>

#include "gpu/device/context.hpp"

namespace darkroom::bench {

/// One pipeline, as far as the library's pipelines differ. Shaders are files of SPIR-V words.
struct BarePipeline {
    std::filesystem::path shader, vertex;  ///< vertex is empty for compute
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    VkFormat output = VK_FORMAT_UNDEFINED;
    VkPipelineColorBlendAttachmentState blend{};
};

/// While it lives, pipelines made through the context's dispatch table are noted. One at a time.
class PipelineNotes {
  public:
    PipelineNotes(gpu::Context& context, std::filesystem::path folder);
    PipelineNotes(const PipelineNotes&) = delete;
    PipelineNotes& operator=(const PipelineNotes&) = delete;
    ~PipelineNotes();
    /// Writes the shaders into the folder. Call it when everything is made.
    [[nodiscard]] Result<std::vector<BarePipeline>> take();

  private:
    gpu::Context& context_;
    gpu::Dispatch before_;
    std::filesystem::path folder_;
};

/// Creates an instance and the device of this name, reads the shaders and makes the pipelines. Milliseconds.
[[nodiscard]] Result<double> bare_start(const std::string& device_name, const std::vector<BarePipeline>& pipelines,
                                        std::span<const std::byte> pipeline_cache);

}  // namespace darkroom::bench
