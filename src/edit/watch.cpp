// SPDX-License-Identifier: MIT
#include "edit/watch.hpp"

namespace darkroom::edit {

bool Watch::take_change() {
    bool is_any = false;
    for (auto& [file, stamp] : files_) {
        const FileStamp now = stamp_of(file);
        if (now == stamp || now == FileStamp{}) continue;
        stamp = now;
        is_any = true;
    }
    return is_any;
}

}  // namespace darkroom::edit
