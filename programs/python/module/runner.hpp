// SPDX-License-Identifier: MIT
#pragma once
// A look on the device, which follows what is edited. One that develops single pictures, or one sequence.

#include <pybind11/numpy.h>

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "develop/developer.hpp"
#include "parts.hpp"

namespace darkroom::python {

[[nodiscard]] std::shared_ptr<Device> create_device(const std::string& select, bool validate);

/// What a frame says of the look's pulses and layers.
struct Moves {
    std::vector<std::string> fire;               ///< events
    std::map<std::string, float> layer_weights;  ///< in this frame; others are the look's
};

class Runner {
  public:
    Runner(std::shared_ptr<Device> device, DevelopTarget target, std::uint32_t frames_in_flight,
           VkExtent2D target_extent);
    Runner(const Runner&) = delete;
    Runner& operator=(const Runner&) = delete;
    ~Runner();

    /// One picture, nothing else under way.
    [[nodiscard]] pybind11::array develop(const EditedLook& edits, const pybind11::dict& frame);
    /// Begins one; at most as many as frames_in_flight are under way.
    void submit(const EditedLook& edits, const pybind11::dict& frame);
    /// Waits for the oldest.
    [[nodiscard]] pybind11::array finish();
    /// Of the last picture that was begun; empty before the first.
    [[nodiscard]] Plan plan();
    /// Of the plan of its last frame.
    [[nodiscard]] std::vector<std::string> told(std::vector<std::string> Plan::*list);

  private:
    [[nodiscard]] Result<> follow(const EditedLook& edits);
    [[nodiscard]] Result<> move(const Moves& moves);
    [[nodiscard]] Result<> submit_locked(const EditedLook& edits, const DevelopInput& input, const Moves& moves);
    [[nodiscard]] Result<DevelopedPicture> finish_locked();

    std::mutex mutex_;  // taken without the interpreter's lock, which is never waited for behind it
    std::shared_ptr<Device> device_;
    DevelopDesc desc_;
    std::optional<Composer> composer_;
    std::optional<Developer> developer_;
    Look look_;  ///< that the Composer holds
    std::uint64_t edition_ = 0;
    std::deque<Result<DevelopedPicture>> finished_;  ///< of plans that another has replaced
    std::deque<std::uint32_t> channels_;             ///< of the pictures under way
};

}  // namespace darkroom::python
