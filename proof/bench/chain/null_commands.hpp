// SPDX-License-Identifier: MIT
#pragma once
// While it lives, what a recording calls of the driver does nothing: what is left is the library's own cost.

#include <type_traits>

#include "gpu/device/dispatch.hpp"

namespace darkroom::bench {

class NullCommands {
  public:
    explicit NullCommands(gpu::Dispatch& vk) : vk_(vk), kept_(vk) {
        drop(vk.UpdateDescriptorSets, vk.CmdBindPipeline, vk.CmdBindDescriptorSets, vk.CmdPipelineBarrier2,
             vk.CmdDispatch, vk.CmdBeginRendering, vk.CmdEndRendering, vk.CmdSetViewport, vk.CmdSetScissor, vk.CmdDraw,
             vk.CmdCopyBufferToImage, vk.CmdClearColorImage, vk.CmdResetQueryPool, vk.CmdWriteTimestamp2);
        vk.CmdBeginDebugUtilsLabelEXT = nullptr;
        vk.CmdEndDebugUtilsLabelEXT = nullptr;
    }
    ~NullCommands() { vk_ = kept_; }
    NullCommands(const NullCommands&) = delete;
    NullCommands& operator=(const NullCommands&) = delete;

  private:
    template <class... Arguments>
    static void drop_one(void (*&function)(Arguments...)) {
        function = [](Arguments...) {};
    }
    template <class... Functions>
    static void drop(Functions&... functions) {
        (drop_one(functions), ...);
    }
    gpu::Dispatch& vk_;
    gpu::Dispatch kept_;
};

}  // namespace darkroom::bench
