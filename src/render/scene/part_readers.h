// SPDX-License-Identifier: MIT
// The readers of a scene file's parts.
#pragma once

#include "render/scene/reader_context.h"
#include "render/scene/scene_reader.h"
#include "render/scene/shape_plugins.h"

namespace h2mc {

class ElementProperties;

// Adds the shape with its material and its area light.
void readShape(ReaderContext& context, const XmlElement& element);

// Adds what a shape "instance" puts into the scene. "shapegroup" adds nothing.
void readInstance(ReaderContext& context, const XmlElement& element);

// Refuses (SceneError) what is too far for rays to be cast and squares of distances to be taken in float.
void checkExtent(const XmlElement& element, const std::string& what, float reach);
void checkExtent(const XmlElement& element, const Shape& shape);
// Notes where a motion is cut into too few pieces.
void noteMotionError(ReaderContext& context, const std::string& name, double error);

// The geometry of a shape "deforming", made of the shapes nested in it, once its own parameters have
// been checked.
ShapeGeometry readDeforming(ReaderContext& context, const ElementProperties& properties);

// Adds a light that stands alone.
void readLight(ReaderContext& context, const XmlElement& element);

// Makes the light that an element describes and keeps it if it emits; its index, or -1.
// `shape`: the shape it is on, -1 for none.
int addLight(ReaderContext& context, const XmlElement& element, int shape);

// Sets the camera, the film and samplesPerPixel.
void readSensor(ReaderContext& context, const XmlElement& element, const ReadOptions& options);

// Set the integrator, its options and the seed; the <dpt> block wins over an <integrator>.
void readIntegrator(ReaderContext& context, const XmlElement& element,
                    std::span<const IntegratorPlugin> integrators);
void readDptBlock(ReaderContext& context, const XmlElement& element,
                  std::span<const IntegratorPlugin> integrators);

}  // namespace h2mc
