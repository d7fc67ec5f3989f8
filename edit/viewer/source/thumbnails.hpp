// SPDX-License-Identifier: MIT
#pragma once
// What effects that are not in a look yet, and other looks, would make of the present picture, small, for who chooses
// one. Only those are made that somebody looks at, one after the other, on a thread of their own.

#include <condition_variable>
#include <darkroom/composer.hpp>
#include <darkroom/look.hpp>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "develop/readback.hpp"
#include "gpu/resource/resources.hpp"
#include "window/pane.hpp"

namespace app {

class Thumbnails {
  public:
    /// An effect that is added to the look, or the file of another look.
    using Subject = std::variant<const darkroom::EffectInfo*, std::filesystem::path>;
    struct Desc {
        darkroom::Look look;
        std::size_t other_looks = 0;                                                              ///< at most
        std::function<darkroom::Result<darkroom::Look>(const std::filesystem::path& file)> read;  ///< on that thread
    };
    struct Shown {
        const darkroom::window::Pane* pane = nullptr;  ///< stays where it is; null: it is on its way
        std::string error{};                           ///< why there will be none
    };
    /// Of a frame that is on its way to main memory. Errors: VkResult.
    [[nodiscard]] static darkroom::Result<std::unique_ptr<Thumbnails>> create(darkroom::Device& device,
                                                                              const darkroom::Frame& frame, Desc desc);
    Thumbnails(const Thumbnails&) = delete;
    Thumbnails& operator=(const Thumbnails&) = delete;
    ~Thumbnails();

    /// Reads the frame, and begins: what record_frame() has recorded has finished. Errors: no thread can be started.
    void record_frame(VkCommandBuffer commands) const { frame_read_.record(commands); }
    [[nodiscard]] darkroom::Result<> begin();
    /// Makes no more; does not wait for the one that is being made.
    void stop();

    /// Asks for one, which comes with a later frame.
    [[nodiscard]] Shown of(const Subject& subject);
    [[nodiscard]] float aspect() const;
    /// Why that of an effect could not be made, once.
    [[nodiscard]] std::optional<darkroom::Error> take_error();
    /// Has one been made, or failed, since the last record()?
    [[nodiscard]] bool has_new() const;
    /// Copies what is new into the image that panes show.
    void record(VkCommandBuffer commands);

  private:
    struct Small;  ///< the frame in main memory, with fewer pixels
    struct Cell {
        std::size_t number = 0;
        darkroom::window::Pane pane;
        bool is_shown = false;
        std::string error;
    };
    Thumbnails(darkroom::Device& device, const darkroom::Frame& frame, Desc desc, darkroom::FrameReadback read);
    [[nodiscard]] VkOffset2D corner_of(std::size_t cell) const;
    void make_all(const std::stop_token& token);

    darkroom::Device& device_;
    darkroom::Frame frame_;
    Desc desc_;
    darkroom::FrameReadback frame_read_;
    VkExtent2D extent_{};  ///< of each
    darkroom::gpu::Image atlas_;
    darkroom::gpu::Buffer staging_;
    bool is_drawn_ = false;  ///< the atlas has been written to

    mutable std::mutex mutex_;  ///< guards the next four
    std::condition_variable_any changed_;
    std::deque<Subject> wanted_;
    std::deque<std::pair<Subject, std::vector<std::uint8_t>>> made_;
    std::map<Subject, Cell> cells_;
    bool has_failed_ = false;  ///< since the last record()
    std::string error_;        ///< likewise guarded: why the last ones could not be made
    std::stop_source stop_;
    std::optional<std::jthread> thread_;
};

}  // namespace app
