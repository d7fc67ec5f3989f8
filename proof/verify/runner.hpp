// SPDX-License-Identifier: MIT
#pragma once
// A subject on the device: its kernels compiled for one stage, complete and then lean, and its pictures read back.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "develop/upload.hpp"
#include "gpu/resource/resources.hpp"
#include "verify/expectation.hpp"
#include "verify/subject.hpp"

namespace darkroom::verify {

/// The frames of a scene on the device; they are only read.
class DeviceScene {
  public:
    [[nodiscard]] static Result<std::unique_ptr<DeviceScene>> create(Device& device, VkExtent2D extent,
                                                                     VkExtent2D output = {});
    [[nodiscard]] Frame frame(std::size_t number) const;
    [[nodiscard]] const std::vector<SceneFrame>& frames() const { return frames_; }

  private:
    std::vector<SceneFrame> frames_;
    std::vector<FrameUpload> uploads_;
};

class Runner {
  public:
    /// Compiles the complete kernels. The scene outlives the runner.
    [[nodiscard]] static Result<std::unique_ptr<Runner>> create(Device& device, const Subject& subject,
                                                                const DeviceScene& scene, KernelStage stage);

    /// The last frame's picture, by the kernels that are there: the complete ones, at first.
    [[nodiscard]] Result<ReferenceImage> run();
    /// From now on the kernels are those of the present values.
    void make_lean() { composer_.wait_for_kernels(); }
    /// Records frame `number` and the copy of its picture, which read() returns once that has finished.
    [[nodiscard]] Result<> record(VkCommandBuffer commands, std::size_t number);
    [[nodiscard]] ReferenceImage read() const;

    [[nodiscard]] const Plan& plan() const { return plan_; }
    /// Of the images of its plan; filter_step is for who knows the device.
    [[nodiscard]] Precision precision() const;
    /// Those that a picture depends on: all of them where there is a history, else the last one alone.
    [[nodiscard]] std::size_t first_frame() const { return has_history_ ? 0 : frame_count - 1; }

  private:
    Runner(Device& device, const DeviceScene& scene);
    [[nodiscard]] Result<> prepare(const Subject& subject, KernelStage stage);

    Device& device_;
    const DeviceScene& scene_;
    Composer composer_;
    Plan plan_;
    bool has_history_ = false;
    gpu::Image target_;
    std::optional<Readback> readback_;
};

}  // namespace darkroom::verify
