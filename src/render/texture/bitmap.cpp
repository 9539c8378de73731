// SPDX-License-Identifier: MIT
#include "render/texture/bitmap.h"

#include <map>
#include <mutex>
#include <tuple>

#include "render/image/image_io.h"

namespace h2mc {

Rgbf BitmapTexture::average() const {
  Vec3<double> sum(0);
  for (const Rgbf& p : image->pixels) sum += Vec3<double>(p);
  return Rgbf(sum / double(image->pixels.size()));
}

Rgbf BitmapTexture::maximum() const {
  Rgbf m(0);
  for (const Rgbf& p : image->pixels) m = glm::max(m, p);
  return m;
}

std::shared_ptr<const Image> BitmapTexture::load(const std::string& path, float gamma,
                                                 const std::string& channel) {
  static std::mutex mutex;
  static std::map<std::tuple<std::string, float, std::string>, std::weak_ptr<const Image>> known;
  const std::scoped_lock lock(mutex);
  std::weak_ptr<const Image>& entry = known[{path, gamma, channel}];
  if (auto image = entry.lock()) return image;
  auto image = std::make_shared<const Image>(readImage(path, gamma, channel));
  entry = image;
  return image;
}

}  // namespace h2mc
