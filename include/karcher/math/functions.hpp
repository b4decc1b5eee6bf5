#pragma once
/// \file
/// All functions of scalars. Nothing outside these headers takes an arccos, an arcsin or a root of what may be zero.

#include "karcher/math/arc_ratio.hpp"
#include "karcher/math/elementary.hpp"
#include "karcher/math/stumpff.hpp"
