#include "splitfusion/lib/render/model_rendering.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/geometry/point_map.h"

namespace splitfusion {
namespace {

Eigen::Vector3f Interpolated(const std::vector<Eigen::Vector3f>& values,
                             const Eigen::Vector3i& triangle,
                             const cv::Vec3f& weights) {
  return weights[0] * values[triangle[0]] + weights[1] * values[triangle[1]] +
         weights[2] * values[triangle[2]];
}

cv::Vec3b InterpolatedColor(const TriangleMesh& mesh,
                            const Eigen::Vector3i& triangle,
                            const cv::Vec3f& weights) {
  cv::Vec3b bgr;
  for (int channel = 0; channel < 3; ++channel) {
    float value = 0;
    for (int k = 0; k < 3; ++k) {
      value += weights[k] * mesh.colors[triangle[k]][2 - channel];
    }
    bgr[channel] = cv::saturate_cast<std::uint8_t>(value);
  }
  return bgr;
}

/// Calls visit(v, u, triangle, weights) for every pixel of one surface.
template <typename Visit>
void ForEachPixel(const MeshRendering& rendering, const Surface& surface,
                  const Visit& visit) {
  const auto first = rendering.first_triangle.find(surface.id());
  if (first == rendering.first_triangle.end()) return;
  const int begin = first->second;
  const int end = begin + static_cast<int>(surface.mesh().triangles.size());
  for (int v = 0; v < rendering.camera.height; ++v) {
    for (int u = 0; u < rendering.camera.width; ++u) {
      const int triangle = rendering.raster.triangle(v, u);
      if (triangle >= begin && triangle < end) {
        visit(v, u, surface.mesh().triangles[triangle - begin],
              rendering.raster.barycentric(v, u));
      }
    }
  }
}

/// Grey values of a rendered model, unsmoothed and smoothed like the coarse
/// level of the live image; pixels outside of the model do not count.
struct ModelGrey {
  cv::Mat_<float> fine;
  cv::Mat_<float> coarse;
};

ModelGrey SmoothGrey(const cv::Mat_<cv::Vec3b>& color, const cv::Mat& mask,
                     int stride) {
  ModelGrey grey;
  grey.fine.create(color.size());
  for (int v = 0; v < color.rows; ++v) {
    for (int u = 0; u < color.cols; ++u) {
      grey.fine(v, u) =
          mask.at<std::uint8_t>(v, u) != 0 ? Intensity(color(v, u)) : 0.0f;
    }
  }
  const double sigma = kGreySigma[1] / stride;
  cv::Mat_<float> inside;
  mask.convertTo(inside, CV_32F, 1.0 / 255);
  cv::GaussianBlur(inside, inside, cv::Size(), sigma);
  cv::GaussianBlur(grey.fine, grey.coarse, cv::Size(), sigma);
  grey.coarse /= cv::max(inside, 1e-3f);  // Maths.
  return grey;
}

/// Number of the pixels with a normal before each row, and of all.
std::vector<int> FirstOfRows(const cv::Mat_<cv::Vec3f>& normals) {
  std::vector<int> first = {0};
  for (int v = 0; v < normals.rows; ++v) {
    const cv::Vec3f* row = normals[v];
    first.push_back(first.back() +
                    static_cast<int>(std::count_if(
                        row, row + normals.cols,
                        [](const cv::Vec3f& n) { return n[2] != 0; })));
  }
  return first;
}

cv::Mat_<float> DepthAlone(const std::vector<Eigen::Vector3f>& vertices,
                           const Surface& surface,
                           const PinholeCamera& camera) {
  Raster raster;
  raster.Clear(camera.Subsampled(kAloneStride));
  RasterizeTriangles(vertices, surface.mesh().triangles,
                     camera.Subsampled(kAloneStride), /*cull_back_faces=*/true,
                     0, &raster);
  return raster.depth;
}

MeshRendering Render(const std::vector<const Surface*>& surfaces,
                     const PinholeCamera& camera) {
  MeshRendering rendering;
  rendering.camera = camera;
  rendering.raster.Clear(camera);
  int first = 0;
  for (const Surface* surface : surfaces) {
    rendering.first_triangle[surface->id()] = first;
    const std::vector<Eigen::Vector3f> vertices = surface->WarpedVertices();
    RasterizeTriangles(vertices, surface->mesh().triangles, camera,
                       /*cull_back_faces=*/true, first, &rendering.raster);
    rendering.alone[surface->id()] = DepthAlone(vertices, *surface, camera);
    first += static_cast<int>(surface->mesh().triangles.size());
  }
  if (first > 0) {
    rendering.normals = ComputePointMap(rendering.raster.depth, camera).normals;
  }
  return rendering;
}

}  // namespace

MeshRendering RenderMeshes(const SurfaceMap& surfaces,
                           const PinholeCamera& camera) {
  std::vector<const Surface*> drawn;
  for (const auto& [id, surface] : surfaces) {
    if (!surface->is_ray_cast() && !surface->inactive()) {
      drawn.push_back(surface.get());
    }
  }
  return Render(drawn, camera);
}

MeshRendering RenderAlone(const Surface& surface, const PinholeCamera& camera) {
  return Render({&surface}, camera);
}

ModelMap RenderBackground(const SurfaceMap& surfaces,
                          const PinholeCamera& camera, int stride,
                          const RayCastOptions& options) {
  const auto found = surfaces.find(0);
  if (found == surfaces.end() || !found->second->is_ray_cast()) return {};
  const Surface& background = *found->second;
  return RayCast(background.volume(), MeanRigidMotion(background.graph()),
                 camera.Subsampled(stride), options);
}

SurfacePrediction ToPrediction(const MeshRendering& rendering,
                               const ModelMap& background,
                               const PinholeCamera& full) {
  LabelImage labels(rendering.camera.height, rendering.camera.width,
                    static_cast<std::uint16_t>(0));
  cv::Mat_<float> depth = rendering.raster.depth.clone();
  tbb::parallel_for(0, labels.rows, [&](int v) {
    for (int u = 0; u < labels.cols; ++u) {
      const int triangle = rendering.raster.triangle(v, u);
      for (const auto& [id, first] : rendering.first_triangle) {
        if (triangle >= first) labels(v, u) = static_cast<std::uint16_t>(id);
      }
      if (background.points.empty()) continue;
      const float behind = background.points(v, u)[2];
      if (!(behind > 0) || (depth(v, u) > 0 && depth(v, u) <= behind)) continue;
      labels(v, u) = 0;
      depth(v, u) = behind;
    }
  });
  SurfacePrediction prediction;
  const cv::Size size(full.width, full.height);
  cv::resize(labels, prediction.labels, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(depth, prediction.depth, size, 0, 0, cv::INTER_NEAREST);
  if (!background.points.empty()) {
    cv::extractChannel(background.points, depth, 2);
    cv::resize(depth, prediction.background, size, 0, 0, cv::INTER_NEAREST);
  }
  return prediction;
}

std::vector<ModelSample> VisibleSamples(const MeshRendering& rendering,
                                        const Surface& surface, int stride) {
  std::vector<ModelSample> samples;
  cv::Mat_<cv::Vec3b> color(rendering.camera.height, rendering.camera.width);
  cv::Mat_<std::uint8_t> mask(color.size(), std::uint8_t{0});
  ForEachPixel(rendering, surface,
               [&](int v, int u, const Eigen::Vector3i& triangle,
                   const cv::Vec3f& weights) {
                 color(v, u) =
                     InterpolatedColor(surface.mesh(), triangle, weights);
                 mask(v, u) = 255;
               });
  const ModelGrey grey = SmoothGrey(color, mask, stride);
  ForEachPixel(rendering, surface,
               [&](int v, int u, const Eigen::Vector3i& triangle,
                   const cv::Vec3f& weights) {
                 const cv::Vec3f& normal = rendering.normals(v, u);
                 if (normal[2] == 0) return;
                 ModelSample sample;
                 sample.point =
                     Interpolated(surface.mesh().vertices, triangle, weights);
                 sample.normal = ToEigen(normal);
                 sample.intensity = {grey.fine(v, u), grey.coarse(v, u)};
                 sample.u = u * stride;
                 sample.v = v * stride;
                 samples.push_back(sample);
               });
  const SkinningIndex& index = surface.skinning_index();
  const WarpField warp(surface.graph());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, samples.size(), 512),
      [&](const tbb::blocked_range<std::size_t>& range) {
        SkinningSupport support;
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          ModelSample& sample = samples[i];
          sample.skinning = index.Skin(sample.point, &support);
          sample.normal = warp.UnwarpNormal(sample.skinning, sample.normal);
        }
      });
  return samples;
}

std::vector<ModelSample> BackgroundSamples(const ModelMap& cast,
                                           const Rigid3d& camera_from_canonical,
                                           int stride) {
  if (cast.points.empty()) return {};
  const Rigid3f canonical_from_camera =
      camera_from_canonical.inverse().cast<float>();
  cv::Mat_<float> depth;
  cv::extractChannel(cast.points, depth, 2);
  const PointMap map = ComputePointMap(depth, cast.camera);
  const ModelGrey grey = SmoothGrey(cast.color, depth > 0, stride);
  const std::vector<int> first = FirstOfRows(map.normals);
  std::vector<ModelSample> samples(first.back());
  tbb::parallel_for(0, depth.rows, [&](int v) {
    int next = first[v];
    for (int u = 0; u < depth.cols; ++u) {
      const cv::Vec3f& normal = map.normals(v, u);
      if (normal[2] == 0) continue;
      ModelSample& sample = samples[next++];
      sample.point = canonical_from_camera * ToEigen(map.points(v, u));
      sample.normal = canonical_from_camera.linear() * ToEigen(normal);
      sample.intensity = {grey.fine(v, u), grey.coarse(v, u)};
      sample.u = u * stride;
      sample.v = v * stride;
      sample.skinning.count = 1;
      sample.skinning.weights[0] = 1;
    }
  });
  return samples;
}

SceneRendering RenderScene(const SurfaceMap& surfaces,
                           const PinholeCamera& camera,
                           const RayCastOptions& options) {
  SceneRendering scene;
  scene.map.Clear(camera);
  scene.labels.create(camera.height, camera.width);
  scene.labels.setTo(0);
  for (const auto& [id, surface] : surfaces) {
    if (surface->is_ray_cast()) {
      scene.map = RayCast(surface->volume(), MeanRigidMotion(surface->graph()),
                          camera, options);
    }
  }
  const MeshRendering meshes = RenderMeshes(surfaces, camera);
  for (const auto& [id, surface] : surfaces) {
    if (surface->is_ray_cast()) continue;
    const WarpField warp(surface->graph());
    const TriangleMesh& mesh = surface->mesh();
    ForEachPixel(meshes, *surface,
                 [&, id = id](int v, int u, const Eigen::Vector3i& triangle,
                              const cv::Vec3f& weights) {
                   const float z = meshes.raster.depth(v, u);
                   const float behind = scene.map.points(v, u)[2];
                   if (behind > 0 && behind < z) return;
                   const int corner = triangle[0];
                   scene.map.points(v, u) = ToCv(camera.BackProject<float>(
                       static_cast<float>(u), static_cast<float>(v), z));
                   scene.map.normals(v, u) = ToCv(warp.WarpNormal(
                       surface->mesh_skinning()[corner],
                       Interpolated(mesh.normals, triangle, weights)));
                   scene.map.color(v, u) =
                       InterpolatedColor(mesh, triangle, weights);
                   scene.labels(v, u) = static_cast<std::uint16_t>(id);
                 });
  }
  return scene;
}

bool AllDrawn(const SurfaceMap& surfaces, const MeshRendering& rendering) {
  return std::all_of(surfaces.begin(), surfaces.end(), [&](const auto& entry) {
    const Surface& surface = *entry.second;
    return surface.is_ray_cast() || surface.inactive() ||
           rendering.first_triangle.count(surface.id()) > 0;
  });
}

}  // namespace splitfusion
