// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/calibrate/inverse.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "fem/campaign/campaign_cache.hpp"
#include "format/error.hpp"
#include "format/number_text.hpp"

namespace palpate::app {
namespace {

std::string constant_name(const fem::RegionConstant& constant) {
  return constant.name + " of " + constant.region;
}

double& value_of(fem::CampaignSettings& campaign, const fem::RegionConstant& constant) {
  for (fem::RegionMaterial& material : campaign.materials) {
    if (material.region != constant.region) continue;
    return material.law.at(constant.name);
  }
  refuse("region '" + constant.region + "'", "the case has no material for it",
         "seek constants of regions of the case");
}

std::string unit_of(const fem::CampaignSettings& campaign, const fem::RegionConstant& constant) {
  for (const fem::RegionMaterial& material : campaign.materials) {
    if (material.region != constant.region) continue;
    return fem::law_constant(material.law.law, constant.name).is_stress ? "Pa" : "1";
  }
  return {};
}

/// Whether constants that are each within their bounds make laws together.
bool admissible(const fem::CampaignSettings& campaign) {
  try {
    for (const fem::RegionMaterial& material : campaign.materials) {
      fem::check_law(material.law, "region '" + material.region + "'");
    }
  } catch (const Error&) {
    return false;
  }
  return true;
}

/// The sought constant that is the only stress of the whole model: contact and supports of no
/// springs take their stiffness from it.
std::optional<std::size_t> modulus_of(const Body& body, const InverseSettings& settings) {
  if (!body.foundation.empty()) return {};
  std::size_t stresses = 0;
  for (const fem::RegionMaterial& material : settings.campaign.materials)
    for (const fem::LawConstant& constant : fem::law_entry(material.law.law).constants)
      stresses += constant.is_stress ? 1 : 0;
  if (stresses != 1) return {};
  for (std::size_t i = 0; i < settings.sought.size(); ++i)
    if (unit_of(settings.campaign, settings.sought[i].constant) == "Pa") return i;
  return {};
}

/// Adds slopes of forces that are proportional to a constant.
void add_slopes_by_modulus(std::size_t index, double modulus,
                           std::vector<fem::SiteSensitivity>& sites) {
  const auto add = [&](std::vector<fem::ForceSensitivity>& samples) {
    for (fem::ForceSensitivity& s : samples)
      s.slope.insert(s.slope.begin() + static_cast<std::ptrdiff_t>(index), s.force / modulus);
  };
  for (fem::SiteSensitivity& site : sites) {
    add(site.samples);
    for (auto& path : site.lateral) add(path);
  }
}

/// The tool of one of several sets of curves.
struct SetTool {
  double radius = 0;
  fem::ToolFriction friction = fem::ToolFriction::Frictionless;

  void use_in(fem::CampaignSettings& campaign) const {
    campaign.indentation.tool.radius = radius;
    campaign.indentation.friction = friction;
  }
};

/// The finite element model of a body.
class BodyModel : public PressModel {
 public:
  /// @param tools  of each set of curves; empty: that of the campaign.
  BodyModel(const Body& body, const InverseSettings& settings, std::vector<SetTool> tools)
      : body_(body), settings_(settings), tools_(std::move(tools)) {}

  std::vector<calibrate::Constant> constants(const PressPlan&) const override {
    std::vector<calibrate::Constant> constants;
    fem::CampaignSettings start = settings_.campaign;
    for (const SoughtConstant& s : settings_.sought)
      constants.push_back({constant_name(s.constant), unit_of(start, s.constant),
                           value_of(start, s.constant), s.low, s.high});
    return constants;
  }
  std::size_t profiled(const PressPlan&) const override { return settings_.sought.size(); }
  std::optional<std::size_t> modulus() const override { return modulus_of(body_, settings_); }

  bool forces(const PressPlan& plan, const std::vector<double>& at,
              std::vector<fem::SiteSensitivity>& sites, std::string& refusal) override {
    fem::CampaignSettings campaign = settings_.campaign;
    const std::optional<std::size_t> scale = modulus();
    std::vector<fem::RegionConstant> constants;
    for (std::size_t i = 0; i < at.size(); ++i) {
      value_of(campaign, settings_.sought[i].constant) = at[i];
      if (i != scale) constants.push_back(settings_.sought[i].constant);
    }
    campaign.sites = plan.vertices;
    if (!tools_.empty()) tools_[plan.set].use_in(campaign);
    // At the start the refusal itself is the best message.
    if (!first_ && !admissible(campaign)) {
      refusal = "refused by the law";
      return false;
    }
    first_ = false;
    sites = fem::run_sensitivity(body_, campaign, plan.depths, constants, plan.lateral, &kept_);
    if (scale) add_slopes_by_modulus(*scale, at[*scale], sites);
    return true;
  }

 private:
  const Body& body_;
  const InverseSettings& settings_;
  std::vector<SetTool> tools_;
  bool first_ = true;
  fem::CampaignCache kept_;
};

void check_tool(const Curves& measured, const InverseSettings& settings) {
  const std::string shape = fem::name_of(settings.campaign.indentation.tool.shape);
  if (measured.tool.shape != shape) {
    refuse("measured curves",
           fmt::format("they were made with a {}, the tool of the case is a {}",
                       measured.tool.shape, shape),
           "set tool.shape of the case to that of the measurement");
  }
  const double radius = settings.campaign.indentation.tool.radius;
  if (std::abs(measured.tool.radius - radius) > 1e-6 * radius) {
    refuse("measured curves",
           fmt::format("they were made with a tool of {} radius, the case has {}",
                       length_text(measured.tool.radius), length_text(radius)),
           "set tool.radius of the case to that of the measurement");
  }
}

/// The tools of several sets of curves, spheres of the case's shape.
std::vector<SetTool> tools_of(std::span<const Curves> measured, const InverseSettings& settings) {
  const std::string shape = fem::name_of(settings.campaign.indentation.tool.shape);
  std::vector<SetTool> tools;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const ToolDescription& tool = measured[i].tool;
    if (tool.shape != shape || shape != "sphere")
      refuse("measured curves",
             fmt::format("curves {} were made with a {}, the tool of the case is a {}", i + 1,
                         tool.shape, shape),
             "calibrate curves of several tools with spheres");
    tools.push_back({tool.radius, tool.friction == "no-slip" ? fem::ToolFriction::NoSlip
                                                             : fem::ToolFriction::Frictionless});
  }
  return tools;
}

void check_sites(const Body& body, const Curves& measured) {
  for (const SiteCurves& site : measured.sites) {
    const auto vertex = static_cast<std::size_t>(site.vertex);
    if (vertex >= body.response.node.size() || body.response.is_site[vertex] == 0)
      refuse(fmt::format("site at vertex {}", site.vertex), "it is no site of the body",
             "import the measurement on this body");
  }
}

}  // namespace

PressFit calibrate_inverse(const Body& body, std::span<const Curves> measured,
                           const InverseSettings& settings) {
  const std::string where = "calibration of body '" + body.name + "'";
  if (settings.sought.empty())
    refuse(where, "no constant is sought", "name at least one with --young or --poisson");
  std::vector<SetTool> tools;
  if (measured.size() == 1)
    check_tool(measured.front(), settings);
  else
    tools = tools_of(measured, settings);
  for (const Curves& curves : measured) check_sites(body, curves);
  BodyModel model(body, settings, std::move(tools));
  return fit_presses(measured, model, settings, where);
}

PressFit calibrate_inverse(const Body& body, const Curves& measured,
                           const InverseSettings& settings) {
  return calibrate_inverse(body, std::span(&measured, 1), settings);
}

}  // namespace palpate::app
