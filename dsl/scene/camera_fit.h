// A camera for scenes that name none.
#pragma once

#include "dsl/scene/scene.h"

namespace patchlight {

// A camera that has the whole scene in its picture, engine lengths: it stands outside, slightly above, on the
// side from which most lit area faces it (it looks through back sides). Emitters far away from everything
// else (a sun) are left out.
Camera fit_camera(const FaceTable& faces);

}  // namespace patchlight
