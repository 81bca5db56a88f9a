// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the config, the colour space of our pictures in it, and the way to its display.
#include "colour.hpp"

#include <OpenColorIO/OpenColorIO.h>

#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include <import/error.hpp>
#include <report/report.hpp>

namespace clerestory {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// What configs call scene-linear light of Rec.709's primaries: ours, ACES's of OpenColorIO 2 and 1,
/// Blender's.
constexpr const char* sceneSpaces[] = {
    "Linear Rec.709 (sRGB)",      "lin_rec709_scene",        "lin_rec709",    "lin_srgb", "Linear Rec.709",
    "Utility - Linear - Rec.709", "Utility - Linear - sRGB", "Linear BT.709", "lin_bt709"};

std::string environmentConfig() {
  const char* const value = std::getenv("OCIO");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return value == nullptr ? "" : value;
}

std::string sceneSpaceOf(const ocio::ConstConfigRcPtr& config) {
  for (const char* name : sceneSpaces) {
    if (const ocio::ConstColorSpaceRcPtr space = config->getColorSpace(name)) return space->getName();
  }
  throw InputError("its config names no linear Rec.709; give that colour space the alias lin_rec709_scene");
}

}  // namespace

struct DisplayTransform::Processor {
  ocio::ConstCPUProcessorRcPtr processor;
};

DisplayTransform::DisplayTransform() : processor_(std::make_unique<Processor>()) {
  const std::string file = environmentConfig();
  isShipped_ = file.empty();
  try {
    std::istringstream shipped{std::string(shippedConfig.text)};
    const ocio::ConstConfigRcPtr config =
        isShipped_ ? ocio::Config::CreateFromStream(shipped) : ocio::Config::CreateFromFile(file.c_str());
    const std::string space = sceneSpaceOf(config);
    display_ = config->getDefaultDisplay();
    view_ = config->getDefaultView(display_.c_str(), space.c_str());
    const ocio::DisplayViewTransformRcPtr transform = ocio::DisplayViewTransform::Create();
    transform->setSrc(space.c_str());
    transform->setDisplay(display_.c_str());
    transform->setView(view_.c_str());
    // Lossless: the faster curves of the default differ by up to one code value.
    processor_->processor =
        config->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
  } catch (const std::exception& error) {
    if (isShipped_)
      throw MachineError(std::string("the colours of pictures cannot be set up: ") + error.what());
    std::string reason = error.what();
    if (reason.ends_with('.')) reason.pop_back();
    throw InputError("the environment variable OCIO is \"" + file + "\": " + reason +
                     "; correct or unset it");
  }
}

DisplayTransform::~DisplayTransform() = default;

void DisplayTransform::apply(std::vector<float>& rgb, int width, int height) const {
  if (rgb.size() != 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::logic_error("a picture has more or fewer pixels than its size");
  if (rgb.empty()) return;
  try {
    ocio::PackedImageDesc description(rgb.data(), width, height, 3);
    processor_->processor->apply(description);
  } catch (const ocio::Exception& error) {
    throw MachineError(std::string("colours could not be converted for the display: ") + error.what());
  }
}

void checkDisplay() {
  const DisplayTransform ignored;
}

}  // namespace clerestory
