// SPDX-License-Identifier: MIT
#pragma once
// All that an engine includes: the device, the composer, and every effect of this build. Looks are apart (look.hpp),
// since they need another library.

#include <darkroom/composer.hpp>
#include <darkroom/custom_effect.hpp>
#include <darkroom/device.hpp>
#include <darkroom/effects.hpp>
#include <darkroom/version.hpp>
