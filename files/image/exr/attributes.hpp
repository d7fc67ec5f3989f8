// SPDX-License-Identifier: MIT
#pragma once
// What an OpenEXR file says of its picture beyond the samples and their layout: comments, lens, time code, camera. It
// is carried from the frame that was read to the picture that was made of it.

#include <OpenEXR/ImfForward.h>

#include <memory>
#include <string>
#include <vector>

namespace darkroom {

class ExrAttributes {
  public:
    /// What a part is written as: another picture of the frame, of which only what is on a list is still true (who made
    /// it, when, with which camera and lens, and what renderers tell of a run), or the same layers again, of which all
    /// is. Nothing of channels, windows, chunks, part names and previews, and of ours not the lights, whose shadows are
    /// parts of the frame.
    enum class Of { Picture, Layers };
    ExrAttributes(const Imf::Header& header, Of of);
    ~ExrAttributes();
    /// Adds them to `header`, but for those it has already, and for what is not true of a part of the frame (its
    /// projection) or of the frame stretched (the shape of its pixels).
    void add_to(Imf::Header& header, bool is_cropped = false, bool is_stretched = false) const;
    /// Those of mattes, whose layers are kept in the same part.
    void add_cryptomatte_to(Imf::Header& header) const;
    /// Names of what a picture of the frame does not say, though its layout does not replace it.
    [[nodiscard]] const std::vector<std::string>& dropped() const { return dropped_; }

  private:
    std::unique_ptr<Imf::Header> kept_;
    std::vector<std::string> dropped_;
};

}  // namespace darkroom
