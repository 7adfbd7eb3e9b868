#include "core/rig/scene_camera.h"

#include <gtest/gtest.h>
