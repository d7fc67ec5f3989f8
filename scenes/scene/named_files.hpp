// SPDX-License-Identifier: MIT
#pragma once
// Which files a scene, its prefabs and its models may name. One rule for all of them.

namespace darkroom::scene {

enum class NamedFiles {
    Any,  ///< wherever the name leads: absolute, through "..", through links
    Own,  ///< what lies, with all links followed, in the folder of the file that names it or below
};

}  // namespace darkroom::scene
