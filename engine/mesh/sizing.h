// What makes a mesh adaptive on a level: how fine it is to be where it is, and which side of the
// surface a place is on as the image has it.
#pragma once
#include "engine/base/vec3.h"
#include "pyramid/image_object.h"
#include "pyramid/size_field.h"

namespace plc {

struct Sizing {
  SizeField field;
  ImageObject object{};
  bool full_image = false;  // of level 0

  // Whether the image says that a place of mesh space is the object's.
  bool inside(Vec3 p) const;
};

}  // namespace plc
