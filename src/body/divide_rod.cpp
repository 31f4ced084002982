#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "body/body_cut.h"
#include "body/rod_body.h"

namespace calot {

Result<RodBody> RodBody::part(int first, int last) const {
  RodBody body(setup_, line_.part(skin_parameters_[first], skin_parameters_[last]));
  body.setup_.nodes = body.line_.nodes();
  body.rest_ = line_.in_part(body.line_, rest_);
  body.part_ = {skin_shares_[first], skin_shares_[last]};
  body.held_at_ = held_at_;
  body.radius_shares_ = radius_shares_;
  body.least_edge_ = *std::min_element(edge_lengths_.begin(), edge_lengths_.end());
  body.skin_parameters_.assign(skin_parameters_.begin() + first, skin_parameters_.begin() + last + 1);
  body.skin_shares_.assign(skin_shares_.begin() + first, skin_shares_.begin() + last + 1);
  if (Result<bool> built = body.build(); !built) return built.failure();
  for (Pinch pinch : pinches_) {
    pinch.at -= first;
    if (pinch.at < 0 || pinch.at > last - first) continue;
    body.hold_flat(pinch);
  }
  return body;
}

int RodBody::point_to_divide_at(double share) const {
  constexpr double on_knot = 1e-9, least_span = 0.2;  // of a span of the whole
  int nearest = -1;
  double least = 2;
  for (int point = 1; point + 1 < static_cast<int>(skin_rest_.size()); ++point) {
    const double off = line_.to_knot(skin_parameters_[point]);
    const double away = std::abs(share_of_length(point) - share);
    if ((off > on_knot && off < least_span) || away >= least) continue;
    nearest = point;
    least = away;
  }
  return nearest;
}

std::optional<Failure> RodBody::check_pieces(int cut) const {
  if (cut < 0)
    return fail(FailureKind::scenario, fmt::format("'{}' is too short to be divided", setup_.name));
  const double share = share_of_length(cut);
  const double shorter = std::min(share, 1 - share) * length_, thick = 2 * radii_[cut];
  if (shorter >= thick) return std::nullopt;
  const std::string hint = 2 * thick > length_
                               ? "it is too short to be divided"
                               : fmt::format("divide it at a share of its length between {:.2f} and {:.2f}",
                                             thick / length_, 1 - thick / length_);
  return fail(FailureKind::scenario,
              fmt::format("a piece of '{}' would be {:.3g} mm long, shorter than it is thick ({:.3g} mm)",
                          setup_.name, 1e3 * shorter, 1e3 * thick),
              hint);
}

Result<BodyPiece> RodBody::piece(int first, int last) const {
  Result<RodBody> part = this->part(first, last);
  if (!part) return part.failure();
  BodyPiece out;
  for (int point = 0; point < static_cast<int>(skin_rest_.size()); ++point) {
    const bool there = point >= first && point <= last;
    out.points.push_back(there ? point - first : -1);
  }
  for (int triangle = 0; triangle < static_cast<int>(skin_.triangles.size()); ++triangle) {
    const int segment = triangle / 2;  // two lie on each
    const bool there = segment >= first && segment < last;
    out.triangles.push_back(there ? triangle - 2 * first : -1);
  }
  out.nodes = [whole = line_, line = part->line_](const VecX& x) { return whole.in_part(line, x); };
  out.begins = way_to(first);
  out.share = share_of_length(last) - share_of_length(first);
  out.body = std::make_shared<const RodBody>(std::move(part).value());
  return out;
}

Result<std::optional<BodyCut>> RodBody::divide(double share) const {
  BodyCut out;
  out.point = point_to_divide_at(share);
  if (std::optional<Failure> failure = check_pieces(out.point)) return *failure;
  out.share = share_of_length(out.point);
  out.open = true;
  const int last = static_cast<int>(skin_rest_.size()) - 1;
  Result<BodyPiece> before = piece(0, out.point), behind = piece(out.point, last);
  if (!before) return before.failure();
  if (!behind) return behind.failure();
  out.pieces = {std::move(before).value(), std::move(behind).value()};
  return std::optional(std::move(out));
}

std::shared_ptr<const Body> RodBody::called(const std::string& name) const {
  auto out = std::make_shared<RodBody>(*this);
  out->setup_.name = name;
  return out;
}

OrganShape RodBody::shape_of_piece(const OrganShape& whole) const {
  auto shape = std::get<TubeShape>(whole);
  shape.points = skin_rest_;
  shape.nodes = nodes();
  shape.radius = radii_.front();
  shape.end_radius = radii_.back();
  if (shape.radii.empty()) return shape;
  shape.end_radius = 0;
  shape.radii.clear();
  for (std::size_t point = 0; point < shape.points.size(); ++point)
    shape.radii.push_back(outer_radius(static_cast<double>(point)));
  return shape;
}

}  // namespace calot
