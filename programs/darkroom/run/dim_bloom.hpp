// SPDX-License-Identifier: MIT
#pragma once
// Bloom that was asked for and finds nothing to glow: the picture is as without it, and one line says why.

#include <darkroom/look.hpp>

#include "develop/developer.hpp"

namespace app {

/// Complains where the look asks for bloom by name and no pixel of this frame, at bloom's place in the stack, is above
/// its threshold. Develops what lies before it anew, so it is for one frame of a run. The images of a DeviceFrame are
/// there already.
void tell_of_dim_bloom(darkroom::Device& device, const darkroom::Composer& composer, const darkroom::Look& look,
                       const darkroom::DevelopDesc& desc, const darkroom::DevelopInput& input);
void tell_of_dim_bloom(darkroom::Device& device, const darkroom::Composer& composer, const darkroom::Look& look,
                       const darkroom::DevelopDesc& desc, darkroom::DeviceFrame input);

}  // namespace app
