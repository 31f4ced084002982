#include "anatomy/organ_frame.h"

namespace calot {

Pose organ_frame(const OrganDefinition& organ) {
  // What has no axis is laid out in the patient's own directions.
  if (const auto* tube = std::get_if<TubeShape>(&organ.shape))
    return Pose(Eigen::Translation3d(tube->points.front()));
  if (const auto* rigid = std::get_if<RigidShape>(&organ.shape))
    return Pose(Eigen::Translation3d(rigid->centre));
  const Vec3 z = (organ.fundus - organ.neck).normalized();
  Vec3 x = organ.liver_side - z * z.dot(organ.liver_side);
  // A liver side along the axis says nothing: any direction across it will do.
  x = x.norm() > 1e-9 ? x.normalized() : z.unitOrthogonal();
  Pose frame = Pose::Identity();
  frame.linear() << x, z.cross(x), z;
  frame.translation() = organ.neck;
  return frame;
}

OrganExtent organ_extent(const OrganDefinition& organ) {
  if (const auto* sphere = std::get_if<SphereShape>(&organ.shape))
    return {sphere->radius, 2 * sphere->radius};
  if (const auto* swept = std::get_if<SweptShape>(&organ.shape)) {
    double widest = 0;
    for (const SweptStation& station : swept->along) widest = std::max(widest, station.radius);
    return {widest, (organ.fundus - organ.neck).norm()};
  }
  const auto* pear = std::get_if<PearShape>(&organ.shape);
  const PearShape shape = pear ? *pear : PearShape{};
  return {0.5 * shape.width, shape.length};
}

}  // namespace calot
