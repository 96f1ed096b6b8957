// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fitting/deformation/compress.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "fitting/deformation/local_part.hpp"
#include "fitting/deformation/modes.hpp"
#include "fitting/response/surface_interpolation.hpp"
#include "format/error.hpp"
#include "format/skin_mesh.hpp"
#include "format/tangent_frame.hpp"
#include "format/to_index.hpp"

namespace palpate::fitting {
namespace {

constexpr std::size_t kKnots = 24;
constexpr double kKnotGrading = 1.5;  ///< knots are closer together near the contact
constexpr double kSameDepth = 1e-6;   ///< relative
/// What rounding the modes to integers adds to a displacement, root mean square over that of the
/// deepest press. Integers that are not finer than need be are small and compress well.
constexpr double kRounding = 3e-4;
constexpr float kLargestInteger = std::numeric_limits<std::int16_t>::max();

bool same(double a, double b) {
  return std::abs(a - b) <= kSameDepth * std::abs(b);
}

std::vector<double> knots_to(double reach) {
  std::vector<double> knots;
  for (std::size_t j = 0; j < kKnots; ++j)
    knots.push_back(reach * std::pow(static_cast<double>(j) / (kKnots - 1), kKnotGrading));
  knots.back() = reach;
  return knots;
}

/// The fields of the lateral deflections along two tangents, per metre, at one depth: the least
/// squares solution of u(d) = (d . t_1) u_1 + (d . t_2) u_2 over the directions d that were run.
/// None where these lie on one line.
std::optional<std::array<Eigen::VectorXf, 2>> along_tangents(const SiteFields& site, double depth,
                                                             const Vec3& first,
                                                             const Vec3& second) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  std::array<Eigen::VectorXf, 2> sums;
  for (const LateralField& field : site.lateral) {
    if (!same(field.depth, depth)) continue;
    const Eigen::Map<const Eigen::VectorXf> u(field.skin.data(),
                                              static_cast<Eigen::Index>(field.skin.size()));
    const Eigen::Vector2d d(dot(field.direction, first), dot(field.direction, second));
    normal += d * d.transpose();
    for (std::size_t i = 0; i < 2; ++i) {
      if (sums[i].size() == 0) sums[i] = Eigen::VectorXf::Zero(u.size());
      sums[i] += static_cast<float>(d[static_cast<Eigen::Index>(i)] / field.travel) * u;
    }
  }
  if (!(normal.determinant() > 1e-3)) return {};
  const Eigen::Matrix2f inverse = normal.inverse().cast<float>();
  return std::array<Eigen::VectorXf, 2>{inverse(0, 0) * sums[0] + inverse(0, 1) * sums[1],
                                        inverse(1, 0) * sums[0] + inverse(1, 1) * sums[1]};
}

class Compression {
 public:
  Compression(const Body& body, const Library& library, const CompressSettings& settings)
      : body_(body), library_(library), settings_(settings), skin_(skin_mesh(body)) {
    d_.surface = surface_digest(library.positions, library.triangles);
    d_.tool_shape = library.tool_shape;
    d_.tool_radius = library.tool_radius;
    d_.reach = settings.reach * library.tool_radius;
    d_.knots = knots_to(d_.reach);
    d_.positions = skin_.positions;
    d_.triangles = skin_.triangles;
    d_.vertex_of = skin_.vertex_of;
    normals_ = inward_normals(d_.positions, d_.triangles);
  }

  void set_tool(const ToolDescription& tool) {
    d_.tool_edge_radius = tool.edge_radius;
    d_.press_slips = tool.friction == "frictionless";
  }

  void choose_depths(const SiteFields& site);
  bool add(const SiteFields& site);
  Deformation finish();

 private:
  void separate(const SiteFields& site, const SiteFrame& frame);
  void add_anisotropic(const std::vector<float>& profiles);
  void add_column(Eigen::VectorXf&& field, double scale);
  float step_of(const Modes& modes, Eigen::Index m) const;
  void set_modes();
  void set_donors();

  const Body& body_;
  const Library& library_;
  CompressSettings settings_;
  SkinMesh skin_;
  std::vector<Vec3> normals_;
  Deformation d_;
  std::vector<std::size_t> vertices_;     ///< of the sites
  std::vector<Eigen::VectorXf> columns_;  ///< of a site: presses, then lateral ones in pairs
  std::vector<float> column_scale_;
};

/// Those of the first site that has all.
void Compression::choose_depths(const SiteFields& site) {
  std::vector<double> depths, lateral;
  for (const NormalField& field : site.normal) depths.push_back(field.depth);
  for (const LateralField& field : site.lateral) lateral.push_back(field.depth);
  std::sort(lateral.begin(), lateral.end());
  lateral.erase(std::unique(lateral.begin(), lateral.end(), same), lateral.end());
  if (depths.size() > d_.depths.size()) d_.depths = depths;
  if (lateral.size() > d_.lateral_depths.size()) d_.lateral_depths = lateral;
}

/// @return false for a site that ended before a depth of the others.
bool Compression::add(const SiteFields& site) {
  if (site.normal.size() != d_.depths.size()) return false;
  const auto vertex = to_index(site.vertex);
  const Vec3& inward = library_.inward[vertex];
  const SiteFrame frame{library_.positions[vertex], inward, tangent_frame(inward)[0]};
  for (const double depth : d_.lateral_depths)
    if (!along_tangents(site, depth, frame.tangent, cross(inward, frame.tangent))) return false;
  separate(site, frame);
  d_.sites.push_back(frame);
  vertices_.push_back(vertex);
  return true;
}

void Compression::separate(const SiteFields& site, const SiteFrame& frame) {
  const LocalPart local(d_.positions, normals_, d_.knots, frame);
  const Vec3 second = cross(frame.inward, frame.tangent);
  const auto append = [](std::vector<float>& all, const std::vector<float>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (const NormalField& field : site.normal) {
    if (field.skin.size() != 3 * d_.positions.size())
      refuse("fields of site " + std::to_string(site.vertex), "are of another body",
             "run 'palpate precompute' again");
    Eigen::VectorXf u = Eigen::Map<const Eigen::VectorXf>(
        field.skin.data(), static_cast<Eigen::Index>(field.skin.size()));
    append(d_.press_local, local.take_press(u, field.depth));
    add_column(std::move(u), 1);
  }
  for (const double depth : d_.lateral_depths) {
    auto u = along_tangents(site, depth, frame.tangent, second).value();
    const LocalPart::Lateral profiles = local.take_lateral(u[0], u[1]);
    append(d_.lateral_local, profiles.symmetric);
    add_anisotropic(profiles.anisotropic);
    // A lateral deflection is of the size of the depth at most.
    for (Eigen::VectorXf& field : u) add_column(std::move(field), depth);
  }
}

/// As integers, of which the largest is that of the largest value.
void Compression::add_anisotropic(const std::vector<float>& profiles) {
  float largest = 0;
  for (const float p : profiles) largest = std::max(largest, std::abs(p));
  const float scale = largest > 0 ? largest / kLargestInteger : 1;
  for (const float p : profiles)
    d_.anisotropic.push_back(static_cast<std::int16_t>(std::lround(p / scale)));
  d_.anisotropic_scale.push_back(scale);
}

void Compression::add_column(Eigen::VectorXf&& field, double scale) {
  columns_.push_back(static_cast<float>(scale) * field);
  column_scale_.push_back(static_cast<float>(scale));
}

/// The step of the integers of a mode. Uniform rounding has the root mean square step / sqrt(12),
/// times the amplitude of the mode, and the modes add up in squares.
float Compression::step_of(const Modes& modes, Eigen::Index m) const {
  const double most = static_cast<double>(modes.coefficients.row(m).cwiseAbs().maxCoeff());
  const double allowed =
      kRounding * d_.depths.back() * std::sqrt(12.0 / static_cast<double>(modes.shapes.cols()));
  return std::max(modes.shapes.col(m).cwiseAbs().maxCoeff() / kLargestInteger,
                  static_cast<float>(allowed / most));
}

void Compression::set_modes() {
  const auto rows = static_cast<Eigen::Index>(3 * d_.positions.size());
  const auto count = static_cast<Eigen::Index>(columns_.size());
  Eigen::MatrixXf fields(rows, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    fields.col(c) = columns_[static_cast<std::size_t>(c)];
    columns_[static_cast<std::size_t>(c)].resize(0);
  }
  const Modes modes = leading_modes(fields, settings_.modes, settings_.least);
  for (Eigen::Index m = 0; m < modes.shapes.cols(); ++m) {
    const float scale = step_of(modes, m);
    d_.mode_scale.push_back(scale);
    for (Eigen::Index i = 0; i < rows; ++i)
      d_.modes.push_back(static_cast<std::int16_t>(std::lround(modes.shapes(i, m) / scale)));
  }
  fields -= modes.shapes * modes.coefficients;
  d_.rms_left_out = static_cast<double>(fields.norm()) / std::sqrt(static_cast<double>(rows) / 3) /
                    std::sqrt(static_cast<double>(count));
  const std::size_t presses = d_.depths.size(), all = presses + 2 * d_.lateral_depths.size();
  for (Eigen::Index c = 0; c < count; ++c) {
    const auto column = static_cast<std::size_t>(c);
    std::vector<float>& to = column % all < presses ? d_.press_modes : d_.lateral_modes;
    for (Eigen::Index m = 0; m < modes.shapes.cols(); ++m)
      to.push_back(modes.coefficients(m, c) / column_scale_[column]);
  }
}

/// A site blends itself; another vertex with a response, the sites around it.
void Compression::set_donors() {
  const SurfaceInterpolation around(library_.positions, library_.inward, vertices_);
  d_.donor_offset.push_back(0);
  for (std::size_t v = 0; v < library_.positions.size(); ++v) {
    std::vector<Donor> donors;
    const auto own = std::lower_bound(vertices_.begin(), vertices_.end(), v);
    if (own != vertices_.end() && *own == v)
      donors = {{v, 1.0}};
    else if (library_.responses[v].status != ResponseStatus::Hole)
      donors = around.weights(v);
    for (const Donor& donor : donors) {
      const auto row = std::lower_bound(vertices_.begin(), vertices_.end(), donor.vertex);
      d_.donor.push_back(static_cast<std::int32_t>(row - vertices_.begin()));
      d_.donor_weight.push_back(static_cast<float>(donor.weight));
    }
    d_.donor_offset.push_back(static_cast<std::int64_t>(d_.donor.size()));
  }
}

Deformation Compression::finish() {
  if (d_.sites.empty())
    refuse("body " + body_.name, "has no site whose press and lateral paths all arrived",
           "look at the reasons in the report, and press less deep");
  set_modes();
  set_donors();
  return std::move(d_);
}

}  // namespace

Deformation compress(const Body& body, const Library& library, const ToolDescription& tool,
                     const std::vector<std::int32_t>& vertices,
                     const std::function<SiteFields(std::int32_t)>& fields,
                     const CompressSettings& settings) {
  Compression compression(body, library, settings);
  compression.set_tool(tool);
  for (const std::int32_t vertex : vertices) compression.choose_depths(fields(vertex));
  for (const std::int32_t vertex : vertices) compression.add(fields(vertex));
  return compression.finish();
}

}  // namespace palpate::fitting
