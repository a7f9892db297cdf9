// back_depth.cpp: distance transform from the outline, and the back's bulge from it.
#include "dynamic/surface/back_depth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace roomradar {
namespace {

constexpr float kFar_px = 1e9F;
constexpr float kDiagonal_px = kCell_px * std::numbers::sqrt2_v<float>;

/// Directions from a lattice point; the opposite of direction k is k ^ 4.
struct Step {
  int x, y;
  float length_px;
};
constexpr std::array<Step, 8> kSteps{{{1, 0, kCell_px},
                                      {1, 1, kDiagonal_px},
                                      {0, 1, kCell_px},
                                      {-1, 1, kDiagonal_px},
                                      {-1, 0, kCell_px},
                                      {-1, -1, kDiagonal_px},
                                      {0, -1, kCell_px},
                                      {1, -1, kDiagonal_px}}};

/// Returns the depth of the back of a surface at depth_m, within all limits.
float limited(float depth_m, float thickness_m, float expected_m, const BackRules& rules) {
  constexpr float kThinnest_m = 0.001F;  // keeps the back behind its front
  if (expected_m > 0.0F) thickness_m = std::min(thickness_m, expected_m - rules.clearance_m - depth_m);
  return depth_m + std::max(thickness_m, kThinnest_m);
}

class BackMaker {
 public:
  BackMaker(const DynamicPixels& pixels, const DynamicLattice& lattice, const DynamicView& view,
            const BackRules& rules, BackLattice& back)
      : pixels_(pixels),
        lattice_(lattice),
        depth_m_(view.measured.depth_m),
        expected_m_(view.expected_depth_m),
        rules_(rules),
        back_(back),
        focal_px_(static_cast<float>(std::min(view.measured.camera.fx_px, view.measured.camera.fy_px))) {
    for (std::size_t k = 0; k < kSteps.size(); ++k)
      to_[k] = static_cast<std::ptrdiff_t>(kSteps[k].y) * lattice.columns + kSteps[k].x;
  }

  void join() {
    visit([&](std::size_t i, int column, int row) {
      const float here = lattice_.inverse_depth[i];
      for (std::size_t k = 0; k < 4; ++k) {
        const int x = column + kSteps[k].x, y = row + kSteps[k].y;
        if (x < 0 || x >= lattice_.columns || y >= lattice_.rows) continue;
        const std::size_t other = at(i, k);
        const float there = lattice_.inverse_depth[other];
        if (!(there > 0.0F) || !rules_.jump.is_one_surface_inverse(here, there)) continue;
        back_.joined[i] |= static_cast<std::uint8_t>(1U << k);
        back_.joined[other] |= static_cast<std::uint8_t>(1U << (k + 4));
      }
    });
  }

  void measure_distances() {
    visit([&](std::size_t i, int column, int row) {
      if ((back_.joined[i] & 0b01010101U) == 0b01010101U || !has_outline(i, column, row)) return;
      // Of the 5 x 5 pixels around a point, half are dynamic on the outline itself, and a fifth more per
      // pixel inside it.
      const CellBits window = pixels_.smooth.square(kCell_px * column - 2, kCell_px * row - 2);
      back_.rim_px[i] =
          std::clamp(5.0F * (static_cast<float>(std::popcount(window)) / 25.0F - 0.5F), 0.5F, 2.5F);
      back_.rim_at[i] = i;
    });
    const auto pass = [&](std::size_t first_step) {
      return [this, first_step](std::size_t i, int, int) {
        for (std::size_t k = first_step; k < first_step + 4; ++k) {
          if ((back_.joined[i] >> k & 1U) == 0) continue;
          const std::size_t other = at(i, k);
          const float through = back_.rim_px[other] + kSteps[k].length_px;
          if (through >= back_.rim_px[i]) continue;
          back_.rim_px[i] = through;
          back_.rim_at[i] = back_.rim_at[other];
        }
      };
    };
    visit(pass(4));       // propagates from above and the left
    visit_back(pass(0));  // propagates from below and the right
  }

  /// Computes the object's half width at each point: the greatest distance from the outline, uphill from
  /// there.
  void measure_widths() {
    back_.width_px = back_.rim_px;
    const auto pass = [&](std::size_t first_step) {
      return [this, first_step](std::size_t i, int, int) {
        for (std::size_t k = first_step; k < first_step + 4; ++k) {
          if ((back_.joined[i] >> k & 1U) == 0) continue;
          const std::size_t other = at(i, k);
          if (back_.rim_px[other] > back_.rim_px[i] + 0.5F * kSteps[k].length_px)
            back_.width_px[i] = std::max(back_.width_px[i], back_.width_px[other]);
        }
      };
    };
    visit(pass(4));
    visit_back(pass(0));
  }

  /// Sums up the bulges of each connected component.
  void measure_bulges() {
    visit([&](std::size_t first, int, int) {
      if (back_.part[first] != 0) return;
      const auto number = static_cast<std::uint32_t>(back_.parts.size());
      BackLattice::Part part;
      back_.part[first] = number;
      back_.stack.push_back(first);
      while (!back_.stack.empty()) {
        const std::size_t i = back_.stack.back();
        back_.stack.pop_back();
        if (back_.rim_px[i] < kFar_px) {
          const double depth_m = 1.0 / lattice_.inverse_depth[i];
          const std::size_t rim = back_.rim_at[i];
          const double bulge_m = 1.0 / lattice_.inverse_depth[rim] - depth_m;
          const double round_m = (round_px(back_.rim_px[i], back_.width_px[i]) -
                                  round_px(back_.rim_px[rim], back_.width_px[i])) *
                                 depth_m / focal_px_;
          part.bulge_by_round += bulge_m * round_m;
          part.round2 += round_m * round_m;
        }
        for (unsigned left = back_.joined[i]; left != 0; left &= left - 1) {
          const std::size_t other = at(i, static_cast<std::size_t>(std::countr_zero(left)));
          if (back_.part[other] != 0) continue;
          back_.part[other] = number;
          back_.stack.push_back(other);
        }
      }
      back_.parts.push_back(part);
    });
  }

  void set_depths() {
    visit([&](std::size_t i, int column, int row) {
      const BackLattice::Part& part = back_.parts[back_.part[i]];
      const double bulge = part.round2 > 0.0 ? part.bulge_by_round / part.round2 : 0.0;
      const float roundness = std::clamp(static_cast<float>(bulge), rules_.least_roundness, 1.0F);
      const float inverse = lattice_.inverse_depth[i];
      const float depth_m = 1.0F / inverse;
      const float thickness_m =
          std::min(rules_.least_thickness_m +
                       2.0F * roundness * round_px(back_.rim_px[i], back_.width_px[i]) * depth_m / focal_px_,
                   rules_.most_thickness_m);
      back_.thickness_m[i] = thickness_m;
      const float back_m = limited(depth_m, thickness_m, least_expected(column, row), rules_);
      back_.inverse_depth[i] = 1.0F / back_m;
      constexpr float kPartOfThickness = 0.3F;
      const float tolerance_m = std::min(kPartOfThickness * (back_m - depth_m), rules_.clearance_m);
      back_.tolerance[i] = std::max(tolerance_m * inverse * inverse, lattice_.sigma[i]);
    });
  }

 private:
  [[nodiscard]] std::size_t at(std::size_t i, std::size_t step) const {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + to_[step]);
  }
  template <typename Do>
  void visit(const Do& work) const {
    for (int row = 0; row < lattice_.rows; ++row) {
      for (int column = 0; column < lattice_.columns; ++column) {
        const std::size_t i = lattice_.index(column, row);
        if (lattice_.inverse_depth[i] > 0.0F) work(i, column, row);
      }
    }
  }
  template <typename Do>
  void visit_back(const Do& work) const {
    for (int row = lattice_.rows - 1; row >= 0; --row) {
      for (int column = lattice_.columns - 1; column >= 0; --column) {
        const std::size_t i = lattice_.index(column, row);
        if (lattice_.inverse_depth[i] > 0.0F) work(i, column, row);
      }
    }
  }

  /// Returns the bulge, in pixels, of a round object of this half width at this distance from its outline.
  static float round_px(float rim_px, float width_px) {
    return rim_px < kFar_px ? std::sqrt(rim_px * (2.0F * width_px - rim_px)) : kFar_px;
  }

  /// Returns true if the object itself ends between this point and one of its four neighbours.
  [[nodiscard]] bool has_outline(std::size_t i, int column, int row) const {
    const float here = lattice_.inverse_depth[i];
    for (std::size_t k = 0; k < kSteps.size(); k += 2) {
      if ((back_.joined[i] >> k & 1U) != 0) continue;
      const int x = kCell_px * (column + kSteps[k].x), y = kCell_px * (row + kSteps[k].y);
      if (!depth_m_.contains(x, y)) continue;  // continues beyond the image
      const float there_m = depth_m_.at(x, y);
      const bool is_behind_it = there_m > 0.0F && there_m * here < 1.0F;  // cut off by a nearer surface
      if (!is_behind_it || rules_.jump.is_one_surface_inverse(here, 1.0F / there_m)) return true;
    }
    return false;
  }

  [[nodiscard]] float least_expected(int column, int row) const {
    float least_m = 0.0F;
    for (int y = kCell_px * row - 2; y <= kCell_px * row + 2; y += 2) {
      for (int x = kCell_px * column - 2; x <= kCell_px * column + 2; x += 2) {
        if (!expected_m_.contains(x, y)) continue;
        const float expected_m = expected_m_.at(x, y);
        if (expected_m > 0.0F && (least_m <= 0.0F || expected_m < least_m)) least_m = expected_m;
      }
    }
    return least_m;
  }

  const DynamicPixels& pixels_;
  const DynamicLattice& lattice_;
  const DepthImage& depth_m_;
  const DepthImage& expected_m_;
  const BackRules& rules_;
  BackLattice& back_;
  float focal_px_;
  std::array<std::ptrdiff_t, 8> to_;
};

}  // namespace

void make_back(const DynamicPixels& pixels, const DynamicLattice& lattice, const DynamicView& view,
               const BackRules& rules, BackLattice& back) {
  const std::size_t size = lattice.inverse_depth.size();
  back.thickness_m.assign(size, 0.0F);
  back.inverse_depth.assign(size, 0.0F);
  back.tolerance.assign(size, 0.0F);
  back.joined.assign(size, 0);
  back.rim_px.assign(size, kFar_px);
  back.rim_at.assign(size, 0);
  back.part.assign(size, 0);
  back.stack.reserve(size);
  back.parts.reserve(size + 1);
  back.parts.assign(1, {});
  BackMaker maker(pixels, lattice, view, rules, back);
  maker.join();
  maker.measure_distances();
  maker.measure_widths();
  maker.measure_bulges();
  maker.set_depths();
}

float back_at(const FrontPixel& front, const DynamicLattice& lattice, const DepthImage& expected_depth_m,
              const BackRules& rules, const BackLattice& back) {
  const int x = front.x, y = front.y;
  const int column = x / kCell_px, row = y / kCell_px;
  const float along_x = static_cast<float>(x % kCell_px) / kCell_px;
  const float along_y = static_cast<float>(y % kCell_px) / kCell_px;
  float thickness_m = 0.0F;
  for (int k = 0; k < 4; ++k) {
    const float weight = (k % 2 == 0 ? 1.0F - along_x : along_x) * (k / 2 == 0 ? 1.0F - along_y : along_y);
    if (!(weight > 0.0F)) continue;  // the point may not exist
    const float there_m = back.thickness_m[lattice.index(column + k % 2, row + k / 2)];
    thickness_m += weight * std::max(there_m, rules.least_thickness_m);
  }
  return 1.0F / limited(1.0F / front.inverse_depth, thickness_m, expected_depth_m.at(x, y), rules);
}

}  // namespace roomradar
