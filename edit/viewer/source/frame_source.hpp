// SPDX-License-Identifier: MIT
#pragma once
// Frames of files for a viewer: one, or a sequence to scrub through. Files are read and decoded on a thread; until the
// one that is asked for is there, the one before stays. Where no thread can be started, who asks for one waits for it.

#include <condition_variable>
#include <list>
#include <map>
#include <mutex>
#include <thread>

#include "core/files.hpp"
#include "develop/upload.hpp"
#include "image/frame/frame_file.hpp"
#include "image/frame/sequence.hpp"
#include "live_source.hpp"
#include "programs/darkroom/run/frames.hpp"
#include "small_frame.hpp"

namespace app {

class FrameSource final : public LiveSource {
  public:
    struct Desc {
        darkroom::FrameOptions options;
        std::optional<double> frames_per_second;
    };
    /// Reads the first frame. Errors are those of the file.
    [[nodiscard]] static darkroom::Result<std::unique_ptr<FrameSource>> create(
        darkroom::Device& device, std::vector<darkroom::NumberedFile> files, const Desc& desc);
    ~FrameSource() override;

    [[nodiscard]] std::optional<VkExtent2D> extent() const override;
    [[nodiscard]] bool must_wait(const LiveMoment& moment, VkExtent2D extent) const override;
    [[nodiscard]] bool is_another(const LiveMoment& moment) const override;
    [[nodiscard]] darkroom::Result<> prepare(const LiveMoment& moment, VkExtent2D extent) override;
    [[nodiscard]] bool is_kept() const override { return !is_new_; }
    [[nodiscard]] darkroom::Result<> record(VkCommandBuffer commands) override;
    [[nodiscard]] darkroom::Frame frame() const override;
    [[nodiscard]] darkroom::CompileDesc compile_desc(VkExtent2D most) const override;
    [[nodiscard]] std::size_t frames() const override { return files_.size() > 1 ? files_.size() : 0; }
    [[nodiscard]] std::string shown_frame(std::size_t number) const override;
    [[nodiscard]] std::vector<std::filesystem::path> files() const override;
    void look_again() override;
    [[nodiscard]] std::vector<std::string> warnings() const override;
    /// Is the frame that was asked for last the one that is shown? For who waits for it.
    [[nodiscard]] bool is_up_to_date() const;
    [[nodiscard]] bool is_coming() const override { return !is_up_to_date(); }

  private:
    /// A frame in main memory.
    struct Decoded {
        std::size_t number = 0;
        darkroom::FileStamp stamp;  ///< of the file, before it was read
        darkroom::FrameFile file;
        std::vector<darkroom::ReferenceLight> lights;
        darkroom::DevelopInput input;  ///< refers to both
    };
    FrameSource(darkroom::Device& device, std::vector<darkroom::NumberedFile> files, const Desc& desc);
    [[nodiscard]] darkroom::Result<std::shared_ptr<Decoded>> decode(std::size_t number) const;
    void work();
    void start();
    void read_here(std::size_t number);
    /// With the lock.
    void keep(std::size_t number, const darkroom::FileStamp& stamp, darkroom::Result<std::shared_ptr<Decoded>> made);
    [[nodiscard]] std::shared_ptr<Decoded> find(std::size_t number) const;  ///< with the lock
    [[nodiscard]] const darkroom::DevelopInput& input() const { return small_ ? small_->input() : shown_->input; }

    darkroom::Device& device_;
    std::vector<darkroom::NumberedFile> files_;
    Desc desc_;

    /// Frames that are kept in main memory, the newest first.
    static constexpr std::size_t max_kept = 6, max_ahead = 3;
    mutable std::mutex mutex_;  ///< guards the next six
    std::condition_variable changed_;
    std::list<std::shared_ptr<Decoded>> kept_;
    std::size_t wanted_ = 0;
    struct Failed {
        darkroom::FileStamp stamp;
        std::string why;
    };
    std::map<std::size_t, Failed> failed_;  ///< not tried again until their files are others
    std::vector<std::string> warnings_;     ///< of the rest
    bool is_ending_ = false;

    std::shared_ptr<Decoded> shown_;
    bool is_new_ = true;  ///< it is still to be uploaded
    bool is_cut_ = true;
    double scale_ = 1;
    std::optional<SmallFrame> small_;  ///< of what is shown, where the scale is below 1
    darkroom::FrameUpload upload_;
    darkroom::Frame frame_;  ///< of what was uploaded last
    std::vector<darkroom::Light> lights_;
    std::optional<std::jthread> thread_;
};

}  // namespace app
