// SPDX-License-Identifier: MIT
#pragma once
// What an OpenEXR file says of its picture beyond the samples and their layout: comments, lens, time code, camera. It
// is carried from the frame that was read to the picture that was made of it.

#include <OpenEXR/ImfForward.h>

#include <memory>

namespace darkroom {

class ExrAttributes {
  public:
    /// Those of a header that are still true of another picture of the same frame: nothing of channels, windows,
    /// chunks, part names and previews, and of ours not the lights, whose shadows are parts of the frame.
    explicit ExrAttributes(const Imf::Header& header);
    ~ExrAttributes();
    /// Adds them to `header`, but for those it has already.
    void add_to(Imf::Header& header) const;

  private:
    std::unique_ptr<Imf::Header> kept_;
};

}  // namespace darkroom
