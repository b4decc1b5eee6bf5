#pragma once
/// \file
/// What a page colours by and draws glyphs of, from the arrays of a Store: energy densities, displacement, angles of directors to the surface normal,
/// directions, components; arrows, director triads, ellipsoids.

#include <nlohmann/json.hpp>
#include <vector>

#include "io/page_data.hpp"
#include "io/page_geometry.hpp"

namespace karcher {

/// The header's "shape" (viewer/src/data.ts: Shape); its numbers go to `arrays`.
/// \param states indices of the stored states that are shown
nlohmann::ordered_json shape_header(const Store& store, const std::vector<int>& states, const PageGeometry& shape, int most_glyphs,
                                    PageArrays& arrays);

}  // namespace karcher
