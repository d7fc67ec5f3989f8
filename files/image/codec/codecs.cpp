// SPDX-License-Identifier: MIT
#include "image/codec/codecs.hpp"

#include "image/codec/load_module.hpp"

namespace darkroom {

Result<const Codecs*> codecs() {
    static const Result<const void*> loaded = load_module("libdarkroom_oiio.so", "darkroom_oiio_codecs", "OpenImageIO");
    if (!loaded) return failure(loaded.error());
    return static_cast<const Codecs*>(*loaded);
}

}  // namespace darkroom
