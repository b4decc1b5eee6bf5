#include "karcher/energy/chiral_skyrmion.hpp"
#include "karcher/energy/dead_load.hpp"
#include "karcher/energy/frank_oseen.hpp"
#include "karcher/energy/harmonic.hpp"
#include "karcher/energy/l2_distance.hpp"

namespace karcher {
namespace {

const std::vector<std::string> every_manifold{"R1", "R2", "R3", "S1", "S2", "S3", "SO3", "SU2", "SPD2", "SPD3", "H2", "H3"};

}  // namespace

EnergyInfo HarmonicModel::info() {
  EnergyInfo info;
  info.type = "harmonic";
  info.description = "Harmonic maps: 1/2 |grad u|^2 in the metric of the manifold (SO3: |axl(Q^T dQ)|^2; SPD: affine-invariant; H: curvature -1).";
  info.dimensions = {1, 2, 3};
  info.fields = {{"field", every_manifold, "the map"}};
  info.parameters = {{"scale", "1", "factor; 2 gives int |grad u|^2", 1.0, 0.0, false}};
  return info;
}

EnergyInfo ChiralSkyrmionModel::info() {
  EnergyInfo info;
  info.type = "chiral-skyrmion";
  info.description = "Chiral magnet film (Melcher 2014): 1/2 |grad u|^2 + kappa u.curl u + h/2 |u - e3|^2, in units of the exchange length.";
  info.dimensions = {2};
  info.fields = {{"field", {"S2"}, "magnetisation"}};
  info.parameters = {{"kappa", "1/length", "strength of the Dzyaloshinskii-Moriya interaction", {}}, {"h", "1/length^2", "field along e3", {}}};
  return info;
}

EnergyInfo FrankOseenModel::info() {
  EnergyInfo info;
  info.type = "frank-oseen";
  info.description = "Nematic liquid crystal in a magnetic field H: 1/2 [K1 (div n)^2 + K2 (n.curl n)^2 + K3 |n x curl n|^2 - chi (n.H)^2].";
  info.dimensions = {2, 3};
  info.fields = {{"field", {"S2"}, "director"}};
  info.parameters = {{"K1", "force", "splay constant", {}, 0.0},
                     {"K2", "force", "twist constant", {}, 0.0},
                     {"K3", "force", "bend constant", {}, 0.0},
                     {"chi", "force/(length H)^2", "anisotropy of the susceptibility", 0.0},
                     {.name = "H", .unit = "H", .description = "magnetic field", .default_value = 0.0, .size = 3}};
  return info;
}

EnergyInfo l2_distance_info() {
  EnergyInfo info;
  info.type = "l2-distance";
  info.description = "weight/2 dist(u, target)^2 with the Riemannian distance of the manifold.";
  info.dimensions = {0, 1, 2, 3};
  info.fields = {{"field", every_manifold, "the map"}};
  info.parameters = {
      {"weight", "1", "factor", 1.0, 0.0},
      {"target", "1", "target map, written like a field's initial value", {}, -std::numeric_limits<double>::infinity(), true, Parameter::ambient}};
  return info;
}

std::vector<EnergyInfo> dead_load_infos() {
  std::vector<EnergyInfo> infos;
  const auto add = [&](const char* type, std::vector<int> dimensions, const char* unit, const char* description) {
    EnergyInfo info;
    info.type = type;
    info.description = description;
    info.dimensions = std::move(dimensions);
    info.fields = {{"field", {"R1", "R2", "R3", "S1", "S2", "S3"}, "the field on which the load works"}};
    info.parameters = {
        {"value", unit, "load in ambient coordinates of the field", {}, -std::numeric_limits<double>::infinity(), true, Parameter::ambient}};
    infos.push_back(std::move(info));
  };
  add("volume", {1, 2, 3}, "force/measure", "Dead load per reference volume (per area of a shell, per length of a rod): - int f.u");
  add("traction", {0, 1, 2}, "force/measure", "Dead load per reference area of a boundary region (per length of a shell's edge): - int f.u");
  add("line", {1}, "force/length", "Dead load per reference length: - int f.u");
  add("point", {0}, "force", "Dead load at every node of the region: - sum f.u");
  return infos;
}

}  // namespace karcher
