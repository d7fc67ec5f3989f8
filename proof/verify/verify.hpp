// SPDX-License-Identifier: MIT
#pragma once
// Every kernel of this build on a device, against the references in double precision: each effect and the chains of
// both orders, in both stages, complete and lean, at several sizes; twice, and in another order, where bits must not
// change. It finds what a driver's compiler makes wrong, and what a device runs too early. It measures no speed.

#include <cstdint>
#include <darkroom/device.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "verify/expectation.hpp"
#include "verify/subject.hpp"

namespace darkroom::verify {

/// A kernel of a subject as it was run.
struct Form {
    KernelStage stage = KernelStage::Compute;  ///< Compute or Raster
    bool is_lean = false;
    VkExtent2D extent{};
};
/// "compute, lean, 67x41".
[[nodiscard]] std::string text_of(const Form& form);

struct Finding {
    enum class Kind : std::uint8_t {
        Reference,  ///< the picture is not the reference's
        Repeat,     ///< the same once more gave other bits
        Order,      ///< beside others, in another order, it gave other bits
        Failed,     ///< it could not be compiled or run: `error`
    };
    Kind kind = Kind::Reference;
    Subject subject;
    Form form;
    std::vector<std::string> kernels;  ///< names of the passes that made the picture
    Difference worst;                  ///< of Repeat and Order: to the picture before, nothing being allowed
    std::string error;
    ReferenceImage made, expected;
    // The least that shows it, of Kind::Reference: no step can go, no value be the default, the picture be no smaller.
    Subject smallest;
    VkExtent2D smallest_extent{};
};
/// "reference", "repeat", "order", "failed".
[[nodiscard]] std::string_view name_of(Finding::Kind kind);
/// One line: subject, form, pixel, channel, value, reference.
[[nodiscard]] std::string text_of(const Finding& finding);

struct Options {
    SubjectOptions subjects;
    double seconds = 0;  ///< no subject is begun later than that; 0: all are tried
    /// The first is that of all subjects; the others are of each effect once.
    std::vector<VkExtent2D> sizes{{67, 41}, {128, 96}, {33, 7}, {1, 1}};
    bool makes_smaller = true;  ///< looks for the least that shows a finding
};

struct Report {
    DeviceInfo device;
    std::uint32_t seed = 1;                                   ///< of the values at random
    std::vector<std::pair<std::string, std::string>> traits;  ///< limits and features that kernels depend on
    std::size_t kernels = 0;                                  ///< pipelines that were made
    std::size_t pictures = 0;                                 ///< that were compared with a reference
    double seconds = 0;
    std::vector<std::string> unchanged;  ///< subjects whose picture is the frame's, bit for bit: little was tried
    std::vector<std::string> not_tried;  ///< and why, if not for want of time
    std::vector<Finding> findings;
};

/// Who is told on the way; both may be empty.
struct Listener {
    std::function<void(const std::string& subject, std::size_t done, std::size_t total)> begins;
    std::function<void(const Finding&)> found;
};

/// Errors: a device of a host's, whose queue is not ours to submit to; one that was lost.
[[nodiscard]] Result<Report> run(Device& device, const Options& options, const Listener& listener = {});

}  // namespace darkroom::verify
