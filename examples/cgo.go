// SPDX-License-Identifier: MIT
// Darkroom in a host in Go, by cgo. What Vulkan does without it is host.h.
//
//	go build -o cgo cgo.go && ./cgo PICTURE.ppm
//
// A struct of Go's that another points to is pinned while C has it. The text of an error is the system thread's that had
// it, so a goroutine stays on its thread between a call and darkroom_error.
package main

/*
#cgo CFLAGS: -std=c99 -I${SRCDIR}
#cgo LDFLAGS: -ldarkroom -lvulkan
#include <darkroom/darkroom.h>
#include "host.h"
*/
import "C"

import (
	"fmt"
	"os"
	"runtime"
	"unsafe"
)

func need(result C.DarkroomResult) {
	if result != C.DARKROOM_OK {
		fmt.Fprintln(os.Stderr, "cgo:", C.GoString(C.darkroom_error()))
		os.Exit(2)
	}
}

func size[T any](of T) C.uint32_t { return C.uint32_t(unsafe.Sizeof(of)) }

func add(composer C.DarkroomComposer, effect string, parameter string, value float64) {
	name, key := C.CString(effect), C.CString(parameter)
	defer C.free(unsafe.Pointer(name))
	defer C.free(unsafe.Pointer(key))
	var handle C.DarkroomHandle
	need(C.darkroom_composer_add(composer, name, nil, &handle))
	if parameter != "" {
		need(C.darkroom_composer_set_number(composer, handle, key, C.double(value)))
	}
}

func main() {
	runtime.LockOSThread()
	var pins runtime.Pinner
	defer pins.Unpin()

	// Of C's memory, because it points into itself.
	host := (*C.Host)(C.calloc(1, C.sizeof_Host))
	defer C.free(unsafe.Pointer(host))
	C.create_device(host)
	defer C.destroy_device(host)
	hdr := C.create_image(host, C.VK_FORMAT_R16G16B16A16_SFLOAT,
		C.VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT|C.VK_IMAGE_USAGE_SAMPLED_BIT)
	defer C.destroy_image(host, hdr)
	target := C.create_image(host, C.VK_FORMAT_R8G8B8A8_UNORM,
		C.VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT|C.VK_IMAGE_USAGE_TRANSFER_SRC_BIT)
	defer C.destroy_image(host, target)
	output := C.create_output(host)
	defer C.destroy_output(host, output)
	extent := C.VkExtent2D{C.width, C.height}

	// Once.
	adopt := C.DarkroomAdoptDesc{instance: host.instance, physical_device: host.gpu, device: host.device,
		queue_family: host.family, enabled_features: &host.features,
		get_proc: C.PFN_vkGetInstanceProcAddr(C.vkGetInstanceProcAddr)}
	adopt.struct_size = size(adopt)
	var device C.DarkroomDevice
	need(C.darkroom_device_adopt(&adopt, &device))
	defer C.darkroom_device_destroy(device)
	var composer C.DarkroomComposer
	need(C.darkroom_composer_create(device, nil, &composer))
	defer C.darkroom_composer_destroy(composer)
	add(composer, "bloom", "intensity", 0.08)
	add(composer, "exposure", "exposure", 1.5)
	add(composer, "tonemap", "", 0)
	add(composer, "encode", "", 0)
	desc := C.DarkroomCompileDesc{max_extent: extent}
	desc.struct_size = size(desc)
	need(C.darkroom_composer_compile(composer, &desc, nil))

	// Every frame.
	begin := C.VkCommandBufferBeginInfo{sType: C.VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO}
	C.vkBeginCommandBuffer(output.commands, &begin)
	C.draw_scene(output.commands, hdr)
	color := C.DarkroomImage{image: hdr.image, view: hdr.view, format: C.VK_FORMAT_R16G16B16A16_SFLOAT, extent: extent,
		layout: C.VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}
	picture := C.DarkroomImage{image: target.image, view: target.view, format: C.VK_FORMAT_R8G8B8A8_UNORM, extent: extent,
		final_layout: C.VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}
	color.struct_size, picture.struct_size = size(color), size(picture)
	pins.Pin(&color)
	pins.Pin(&picture)
	frame := C.DarkroomFrame{color: &color, target: &picture}
	frame.struct_size = size(frame)
	need(C.darkroom_composer_record(composer, output.commands, &frame))
	C.submit(host, output, target)

	path := C.CString(os.Args[1])
	defer C.free(unsafe.Pointer(path))
	C.save(host, output, path)
}
