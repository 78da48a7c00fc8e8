// Reads a frozen problem (docs/solvers.md) and solves it with Ceres, without
// the toolkit that wrote it: solve_frozen FILE.h5
//
// The energy is the sum of
//
//   E_term = weight / N * sum over residual vectors of rho(|r|^2 / s^2)
//
// with s = 1 cm and N the number of residual vectors, or the sum of their
// confidences. Unknown are 6 numbers a node, [omega, tau]: R <- exp(omega) R,
// t <- t + tau.

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <hdf5.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr double kUnit = 0.01;  // s, metres.
constexpr int kMaxNodes = 8;    // That carry a point.

/// The datasets and attributes of a file; all numbers as double.
class File {
 public:
  explicit File(const std::string& path)
      : id_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {
    if (id_ < 0) throw std::runtime_error(path + ": not an HDF5 file");
  }
  ~File() { H5Fclose(id_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool Has(const std::string& path) const {
    return H5Lexists(id_, path.c_str(), H5P_DEFAULT) > 0;
  }

  std::vector<double> Numbers(const std::string& path) const {
    const hid_t dataset = H5Dopen2(id_, path.c_str(), H5P_DEFAULT);
    if (dataset < 0) throw std::runtime_error(path + ": missing");
    const hid_t space = H5Dget_space(dataset);
    std::vector<double> numbers(H5Sget_simple_extent_npoints(space));
    const herr_t status = H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                                  H5P_DEFAULT, numbers.data());
    H5Sclose(space);
    H5Dclose(dataset);
    if (status < 0) throw std::runtime_error(path + ": damaged");
    return numbers;
  }

  double Number(const std::string& name) const {
    double value = 0;
    const hid_t attribute = H5Aopen(id_, name.c_str(), H5P_DEFAULT);
    if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0) {
      throw std::runtime_error(name + ": missing");
    }
    H5Aclose(attribute);
    return value;
  }

  std::string Text(const std::string& name) const {
    const hid_t attribute = H5Aopen(id_, name.c_str(), H5P_DEFAULT);
    if (attribute < 0) throw std::runtime_error(name + ": missing");
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    const bool one = H5Sget_simple_extent_npoints(space) == 1;
    H5Sclose(space);
    if (!one) throw std::runtime_error(name + ": not a text");
    std::string text(H5Tget_size(type), '\0');
    H5Aread(attribute, type, text.data());
    H5Tclose(type);
    H5Aclose(attribute);
    return text;
  }

 private:
  hid_t id_;
};

Eigen::Vector3d Vector(const std::vector<double>& numbers, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3d>(&numbers[3 * i]);
}

/// One term of the attribute `energy`: NAME(KEY=VALUE,...).
struct Term {
  std::string name;
  std::map<std::string, std::string> keys;

  double At(const std::string& key) const { return std::stod(keys.at(key)); }

  /// weight / N * rho, in the units of Ceres, whose costs have a factor 1/2.
  ceres::LossFunction* Loss(double count) const {
    const double scale = At("scale") / kUnit;
    const std::string& kind = keys.at("loss");
    ceres::LossFunction* rho = nullptr;
    if (kind == "huber") rho = new ceres::HuberLoss(scale);
    if (kind == "tukey") rho = new ceres::TukeyLoss(scale);
    if (kind == "cauchy") rho = new ceres::CauchyLoss(scale);
    return new ceres::ScaledLoss(rho, 2 * At("weight") / count,
                                 ceres::TAKE_OWNERSHIP);
  }
};

std::vector<Term> ParseEnergy(const std::string& text) {
  std::vector<Term> terms;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    Term term;
    const std::size_t open = word.find('(');
    term.name = word.substr(0, open);
    std::istringstream pairs(word.substr(open + 1, word.size() - open - 2));
    for (std::string pair; std::getline(pairs, pair, ',');) {
      const std::size_t equals = pair.find('=');
      term.keys[pair.substr(0, equals)] = pair.substr(equals + 1);
    }
    terms.push_back(term);
  }
  return terms;
}

/// The deformation graph; `motions`: "graph", or "before".
struct Graph {
  Graph(const File& file, const std::string& motions)
      : position(file.Numbers("graph/position")),
        rotation(file.Numbers(motions + "/rotation")),
        translation(file.Numbers(motions + "/translation")) {}

  std::size_t size() const { return position.size() / 3; }
  Eigen::Matrix3d R(std::size_t i) const {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    return Eigen::Map<const RowMajor>(&rotation[9 * i]);
  }
  /// g + t.
  Eigen::Vector3d Center(std::size_t i) const {
    return Vector(position, i) + Vector(translation, i);
  }

  std::vector<double> position, rotation, translation;
};

/// What carries a model point: x = sum_k w_k [exp(omega_k) q_k + c_k + tau_k],
/// q_k = R_k (p - g_k), c_k = g_k + t_k (Eq. 1 and 2).
struct Carried {
  int count = 0;
  int nodes[kMaxNodes];
  double weights[kMaxNodes];
  Eigen::Vector3d q[kMaxNodes], c[kMaxNodes];

  template <typename T>
  void Warp(T const* const* twists, T* x) const {
    for (int d = 0; d < 3; ++d) x[d] = T(0);
    for (int k = 0; k < count; ++k) {
      const T arm[3] = {T(q[k][0]), T(q[k][1]), T(q[k][2])};
      T turned[3];
      ceres::AngleAxisRotatePoint(twists[k], arm, turned);
      for (int d = 0; d < 3; ++d) {
        x[d] += T(weights[k]) * (turned[d] + T(c[k][d]) + twists[k][3 + d]);
      }
    }
  }
};

/// The model points of a group of the file.
std::vector<Carried> ReadCarried(const File& file, const std::string& group,
                                 const Graph& graph) {
  const auto point = file.Numbers(group + "/point");
  const auto nodes = file.Numbers(group + "/nodes");
  const auto weights = file.Numbers(group + "/weights");
  const auto counts = file.Numbers(group + "/node_count");
  std::vector<Carried> all(counts.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    Carried& carried = all[i];
    carried.count = static_cast<int>(counts[i]);
    for (int k = 0; k < carried.count; ++k) {
      const auto node = static_cast<std::size_t>(nodes[kMaxNodes * i + k]);
      carried.nodes[k] = static_cast<int>(node);
      carried.weights[k] = weights[kMaxNodes * i + k];
      carried.q[k] =
          graph.R(node) * (Vector(point, i) - Vector(graph.position, node));
      carried.c[k] = graph.Center(node);
    }
  }
  return all;
}

/// r = sqrt(c) n . (x - v): point_to_plane with n the model normal under the
/// warp, live_to_model with the way to the live point.
struct Plane {
  Carried carried;
  Eigen::Vector3d normal, target;
  double root;  ///< sqrt(c).

  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    T x[3];
    carried.Warp(twists, x);
    residual[0] = T(0);
    for (int d = 0; d < 3; ++d) {
      residual[0] += T(normal[d]) * (x[d] - T(target[d]));
    }
    residual[0] *= T(root / kUnit);
    return true;
  }
};

/// r = sqrt(c) [x_3 - D], D the depth of the plane through the live point where
/// the view ray of x meets it: projective_depth.
struct Depth {
  Carried carried;
  Eigen::Vector3d normal, target;
  double root;  ///< sqrt(c).

  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    T x[3];
    carried.Warp(twists, x);
    const T along =
        T(normal[0]) * x[0] + T(normal[1]) * x[1] + T(normal[2]) * x[2];
    if (along == T(0)) return false;
    residual[0] =
        T(root / kUnit) * x[2] * (T(1) - T(normal.dot(target)) / along);
    return true;
  }
};

/// r = m sqrt(c) [d + grad I . (pi(x) - u_0)].
struct Color {
  Carried carried;
  Eigen::Vector2d focal, offset, gradient;
  double difference, root, metres;

  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    T x[3];
    carried.Warp(twists, x);
    const T du = T(focal[0]) * x[0] / x[2] + T(offset[0]);
    const T dv = T(focal[1]) * x[1] / x[2] + T(offset[1]);
    residual[0] = T(metres * root / kUnit) *
                  (T(difference) + T(gradient[0]) * du + T(gradient[1]) * dv);
    return true;
  }
};

/// r = sqrt(c) (z_t [pi(x) - pi(v_t)], sqrt(d) [x_3 - z_t]).
struct Track {
  Carried carried;
  Eigen::Vector3d target;
  double root, along;  ///< sqrt(c), sqrt(d).

  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    T x[3];
    carried.Warp(twists, x);
    for (int d = 0; d < 2; ++d) {
      residual[d] = T(root * target[2] / kUnit) *
                    (x[d] / x[2] - T(target[d] / target[2]));
    }
    residual[2] = T(root * along / kUnit) * (x[2] - T(target[2]));
    return true;
  }
};

/// r = c_i + tau_i - c_j - tau_j - exp(omega_i) q.
struct Edge {
  Eigen::Vector3d apart, q;  ///< c_i - c_j; q in the camera frame.
  double root = 1;           ///< Of the weight.

  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    const T arm[3] = {T(q[0]), T(q[1]), T(q[2])};
    T turned[3];
    ceres::AngleAxisRotatePoint(twists[0], arm, turned);
    for (int d = 0; d < 3; ++d) {
      residual[d] = T(root / kUnit) * (T(apart[d]) + twists[0][3 + d] -
                                       twists[1][3 + d] - turned[d]);
    }
    return true;
  }
};

/// Roots of the confidences of a group, single precision as in the toolkit.
std::vector<double> Roots(const File& file, const std::string& group) {
  std::vector<double> roots = file.Numbers(group + "/confidence");
  for (double& root : roots) root = std::sqrt(static_cast<float>(root));
  return roots;
}

double Sum(const std::vector<double>& numbers) {
  double sum = 0;
  for (const double number : numbers) sum += number;
  return sum;
}

/// The problem in terms of Ceres.
class Problem {
 public:
  explicit Problem(const File& file)
      : file_(file), graph_(file, "graph"), twists_(6 * graph_.size(), 0.0) {
    total_ = Sum(file.Numbers("correspondences/confidence"));
    for (const Term& term : ParseEnergy(file.Text("energy"))) Add(term);
  }

  double Cost() {
    double cost = 0;
    problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
    return cost;
  }

  ceres::Solver::Summary Solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = graph_.size() == 1
                                     ? ceres::DENSE_NORMAL_CHOLESKY
                                     : ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-12;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return summary;
  }

 private:
  void Add(const Term& term) {
    if (term.At("weight") == 0) return;
    if (term.name == "point_to_plane") {
      return AddDistances<Plane>(term, "warped_normal");
    }
    if (term.name == "projective_depth") {
      return AddDistances<Depth>(term, "target_normal");
    }
    if (term.name == "color") return AddColors(term);
    if (term.name == "live_to_model") return AddLost(term);
    if (term.name == "tracks") return AddTracks(term);
    if (term.name == "arap") return AddEdges(term, graph_, 1);
    if (term.name == "temporal_arap") return AddTemporal(term);
    throw std::runtime_error("term " + term.name + ": not in this example");
  }

  /// `dims`: residuals of the functor.
  template <typename Functor>
  void AddBlock(Functor* functor, const int* nodes, int count, int dims,
                ceres::LossFunction* loss) {
    auto* cost = new ceres::DynamicAutoDiffCostFunction<Functor, 6>(functor);
    std::vector<double*> blocks;
    for (int k = 0; k < count; ++k) {
      cost->AddParameterBlock(6);
      blocks.push_back(&twists_[6 * nodes[k]]);
    }
    cost->SetNumResiduals(dims);
    problem_.AddResidualBlock(cost, loss, blocks);
  }

  template <typename Functor>
  void AddPoint(const Functor& functor, int dims, ceres::LossFunction* loss) {
    auto* copy = new Functor(functor);
    AddBlock(copy, copy->carried.nodes, copy->carried.count, dims, loss);
  }

  /// `normals`: the dataset of those that the functor takes.
  template <typename Functor>
  void AddDistances(const Term& term, const std::string& normals) {
    const auto carried = ReadCarried(file_, "correspondences", graph_);
    const auto normal = file_.Numbers("correspondences/" + normals);
    const auto target = file_.Numbers("correspondences/target");
    const auto root = Roots(file_, "correspondences");
    for (std::size_t i = 0; i < carried.size(); ++i) {
      AddPoint(
          Functor{carried[i], Vector(normal, i), Vector(target, i), root[i]}, 1,
          term.Loss(total_));
    }
  }

  void AddColors(const Term& term) {
    const auto exposure = term.keys.find("exposure");  // None in version 1.
    if (exposure != term.keys.end() && exposure->second == "true") {
      throw std::runtime_error("color(exposure=true): not in this example");
    }
    const auto carried = ReadCarried(file_, "correspondences", graph_);
    const auto pixel = file_.Numbers("correspondences/pixel");
    const auto gradient = file_.Numbers("correspondences/intensity_gradient");
    const auto difference =
        file_.Numbers("correspondences/intensity_difference");
    const auto root = Roots(file_, "correspondences");
    const Eigen::Vector2d focal(file_.Number("fx"), file_.Number("fy"));
    const Eigen::Vector2d principal(file_.Number("cx"), file_.Number("cy"));
    for (std::size_t i = 0; i < carried.size(); ++i) {
      AddPoint(
          Color{carried[i], focal,
                principal - Eigen::Vector2d(pixel[2 * i], pixel[2 * i + 1]),
                Eigen::Vector2d(gradient[2 * i], gradient[2 * i + 1]),
                difference[i], root[i], term.At("metres")},
          1, term.Loss(total_));
    }
  }

  void AddLost(const Term& term) {
    if (!file_.Has("lost")) return;
    const auto carried = ReadCarried(file_, "lost", graph_);
    const auto target = file_.Numbers("lost/target");
    const auto root = Roots(file_, "lost");
    const double total = total_ + Sum(file_.Numbers("lost/confidence"));
    const std::vector<double> zero(6, 0.0);
    for (std::size_t i = 0; i < carried.size(); ++i) {
      Eigen::Vector3d x;
      const double* twists[kMaxNodes];
      for (auto& twist : twists) twist = zero.data();
      carried[i].Warp(twists, x.data());
      const Eigen::Vector3d way = (Vector(target, i) - x).normalized();
      AddPoint(Plane{carried[i], way, Vector(target, i), root[i]}, 1,
               term.Loss(total));
    }
  }

  void AddTracks(const Term& term) {
    if (!file_.Has("tracks")) return;
    const auto carried = ReadCarried(file_, "tracks", graph_);
    const auto target = file_.Numbers("tracks/target");
    const auto root = Roots(file_, "tracks");
    const double total = total_ + Sum(file_.Numbers("tracks/confidence"));
    for (std::size_t i = 0; i < carried.size(); ++i) {
      const double z = target[3 * i + 2];
      const double off = z - file_.Number("noise_best");
      const double sigma = file_.Number("noise_least") +
                           file_.Number("noise_growth") * off * off;
      const double exactness = z / file_.Number("fx") / sigma;
      AddPoint(Track{carried[i], Vector(target, i), root[i],
                     std::sqrt(term.At("depth")) * std::min(1.0, exactness)},
               3, term.Loss(total));
    }
  }

  void AddTemporal(const Term& term) {
    const double anneal = file_.Number("anneal");
    if (!file_.Has("before") || anneal <= 1) return;
    AddEdges(term, Graph(file_, "before"), std::sqrt(anneal - 1));
  }

  /// Edges as they are in `rest`, turned with their first nodes; at rest if
  /// that is the graph itself.
  void AddEdges(const Term& term, const Graph& rest, double root) {
    const auto edges = file_.Numbers("edges/nodes");
    for (std::size_t e = 0; 2 * e < edges.size(); ++e) {
      const int nodes[2] = {static_cast<int>(edges[2 * e]),
                            static_cast<int>(edges[2 * e + 1])};
      const auto [i, j] = nodes;
      const Eigen::Vector3d edge =
          &rest == &graph_ ? Eigen::Vector3d(Vector(graph_.position, i) -
                                             Vector(graph_.position, j))
                           : Eigen::Vector3d(rest.R(i).transpose() *
                                             (rest.Center(i) - rest.Center(j)));
      AddBlock(new Edge{graph_.Center(i) - graph_.Center(j), graph_.R(i) * edge,
                        root},
               nodes, 2, 3, term.Loss(double(edges.size()) / 2));
    }
  }

  const File& file_;
  Graph graph_;
  std::vector<double> twists_;
  ceres::Problem problem_;
  double total_ = 0;  // Of the confidences of the correspondences.
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: solve_frozen FILE.h5\n");
    return 2;
  }
  try {
    const File file(argv[1]);
    Problem problem(file);
    const double start = problem.Cost(), own = file.Number("start_cost");
    std::printf("start: %.12g; the run's: %.12g; they differ by %.1e\n", start,
                own, std::abs(start - own) / own);
    const ceres::Solver::Summary summary = problem.Solve();
    std::printf("minimum: %.12g; %s\n", summary.final_cost,
                summary.BriefReport().c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "solve_frozen: %s: %s\n", argv[1], error.what());
    return 2;
  }
}
