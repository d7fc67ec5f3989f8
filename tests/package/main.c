// What is installed serves C, too.
#include <darkroom/darkroom.h>
#include <stdio.h>

int main(void) {
    DarkroomDevice device = NULL;
    DarkroomComposer composer = NULL;
    if (darkroom_version() != DARKROOM_VERSION) return 1;
    if (darkroom_device_assumed(DARKROOM_DEVICE_PROFILE_GPU, &device) != DARKROOM_OK) return 1;
    if (darkroom_composer_create(device, NULL, &composer) != DARKROOM_OK) return 1;
    if (darkroom_composer_add(composer, "none", NULL, NULL) != DARKROOM_ERROR_USER) return 1;
    printf("%s\n", darkroom_error());
    darkroom_composer_destroy(composer);
    darkroom_device_destroy(device);
    return 0;
}
