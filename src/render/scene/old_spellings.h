// SPDX-License-Identifier: MIT
// Names and customs of Mitsuba before 0.4, in today's words.
#pragma once

#include "render/scene/xml_document.h"

namespace h2mc {

// Changes a <scene> of a version below 2 as Mitsuba's own upgrades from 0.2 to 0.6 do: plugins and
// parameters that were renamed, the handedness of cameras, lookAt with nine numbers. Elements keep their
// places in the file. Throws SceneError for what cannot be said in today's words.
void modernise(XmlElement& scene);

}  // namespace h2mc
