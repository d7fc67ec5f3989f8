// SPDX-License-Identifier: MIT
#pragma once
// Whether sixteen numbers may be a camera. Files are known that hold zeros for the camera that a program did not have.

#include <darkroom/result.hpp>
#include <string_view>

#include "image/frame/frame_file.hpp"

namespace darkroom {

/// That the numbers are finite and the matrix has an inverse: through another one nothing is seen. The error begins
/// with the name.
[[nodiscard]] Result<> check_camera_matrix(std::string_view name, const Matrix& matrix);
/// The same of all matrices that a frame has, by their names in files.
[[nodiscard]] Result<> check_camera(const FrameCamera& camera);

}  // namespace darkroom
