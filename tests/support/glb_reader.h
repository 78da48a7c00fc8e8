#ifndef SPLITFUSION_TESTS_SUPPORT_GLB_READER_H_
#define SPLITFUSION_TESTS_SUPPORT_GLB_READER_H_

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace splitfusion {

/// A binary glTF file as a viewer would show it, as far as sf_export uses it.
class GlbReader {
 public:
  /// Expects that the file is well formed: heads, lengths, accessors within
  /// their views, indices within their lists, bounds.
  explicit GlbReader(const std::string& path);

  /// Its JSON.
  const nlohmann::json& json() const { return json_; }

  /// Index of the node of a name; -1 if there is none.
  int Node(const std::string& name) const;

  /// World matrix of a node at a time, seconds.
  Eigen::Matrix4d MatrixAt(int node, double time) const;

  /// Vertices of the mesh of a node at a time: morphed, skinned.
  std::vector<Eigen::Vector3d> VerticesAt(int node, double time) const;
  /// Their normals, unit length.
  std::vector<Eigen::Vector3d> NormalsAt(int node, double time) const;
  /// Colours of the vertices, sRGB, 0..255.
  std::vector<Eigen::Vector3d> Colors(int node) const;
  /// Of every vertex its index in mesh.ply.
  std::vector<double> Source(int node) const;
  /// Corners of the triangles.
  std::vector<double> Indices(int node) const;

  /// Elements of an accessor, one after another.
  std::vector<double> Array(int accessor) const;

 private:
  /// A channel's value at a time; empty if there is none.
  std::vector<double> Animated(int node, const std::string& path,
                               double time) const;
  Eigen::Matrix4d LocalAt(int node, double time) const;
  const nlohmann::json& Primitive(int node) const;
  /// An attribute with its morph targets.
  std::vector<double> MorphedAt(int node, const std::string& attribute,
                                double time) const;
  /// Of every vertex the matrix that moves it.
  std::vector<Eigen::Matrix4d> SkinningAt(int node, double time) const;
  void CheckAccessors() const;

  nlohmann::json json_;
  std::string bytes_;
  std::vector<int> parents_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_GLB_READER_H_
