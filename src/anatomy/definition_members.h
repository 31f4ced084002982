#pragma once
// The members of what a scenario declares (definitions.h), for digests and bytes.

#include "anatomy/definitions.h"
#include "geometry/state_members.h"

namespace calot {

void visit_members(auto&& visit, MembersOf<SphereShape> auto& definition) {
  auto& [radius] = definition;
  visit(radius);
}
void visit_members(auto&& visit, MembersOf<PearShape> auto& definition) {
  auto& [length, width, refine, refine_radius] = definition;
  visit(length, width, refine, refine_radius);
}
void visit_members(auto&& visit, MembersOf<SweptStation> auto& definition) {
  auto& [at, radius, refine] = definition;
  visit(at, radius, refine);
}
void visit_members(auto&& visit, MembersOf<SweptShape> auto& definition) {
  auto& [along] = definition;
  visit(along);
}
void visit_members(auto&& visit, MembersOf<MeshFile> auto& definition) {
  auto& [path, scale, turn, offset, axes, through_points] = definition;
  visit(path, scale, turn, offset, axes, through_points);
}
void visit_members(auto&& visit, MembersOf<TubeShape> auto& definition) {
  auto& [points, radius, end_radius, nodes, pressure, patient_end, carries, feed_pressure, feed_resistance,
         radii] = definition;
  visit(points, radius, end_radius, nodes, pressure, patient_end, carries, feed_pressure, feed_resistance,
        radii);
}
void visit_members(auto&& visit, MembersOf<RigidShape> auto& definition) {
  auto& [size, rounding, centre, density, stiffness, ring, path, scale, turn] = definition;
  visit(size, rounding, centre, density, stiffness, ring, path, scale, turn);
}
void visit_members(auto&& visit, MembersOf<LobeShape> auto& definition) {
  auto& [width, depth, thickness, edge, edge_angle, overhang, bed_length, bed_width, bed_depth, young,
         poisson, density, capsule, capsule_slack, sags, hold] = definition;
  visit(width, depth, thickness, edge, edge_angle, overhang, bed_length, bed_width, bed_depth, young, poisson,
        density, capsule, capsule_slack, sags, hold);
}
void visit_members(auto&& visit, MembersOf<FibreDefinition> auto& definition) {
  auto& [stiffness, stiffening, angle] = definition;
  visit(stiffness, stiffening, angle);
}
void visit_members(auto&& visit, MembersOf<WallDefinition> auto& definition) {
  auto& [thickness, shear_modulus, stiffening, fibres, overstretch, perforation_stretch, pinch_limit,
         burn_energy, density, retardation, burn_reach, raw_energy] = definition;
  visit(thickness, shear_modulus, stiffening, fibres, overstretch, perforation_stretch, pinch_limit,
        burn_energy, density, retardation, burn_reach, raw_energy);
}
void visit_members(auto&& visit, MembersOf<BileDefinition> auto& definition) {
  auto& [density, fill_volume, fill_pressure] = definition;
  visit(density, fill_volume, fill_pressure);
}
void visit_members(auto&& visit, MembersOf<HeldRegion> auto& definition) {
  auto& [name, landmark, radius, stiffness, while_filled] = definition;
  visit(name, landmark, radius, stiffness, while_filled);
}
void visit_members(auto&& visit, MembersOf<InjuryDefinition> auto& definition) {
  auto& [cut, closed, partly, unclipped, near_start, together] = definition;
  visit(cut, closed, partly, unclipped, near_start, together);
}
void visit_members(auto&& visit, MembersOf<InjuryNearStart> auto& definition) {
  auto& [within, called] = definition;
  visit(within, called);
}
void visit_members(auto&& visit, MembersOf<InjuryTogether> auto& definition) {
  auto& [with, called] = definition;
  visit(with, called);
}
void visit_members(auto&& visit, MembersOf<OrganDefinition> auto& definition) {
  auto& [name, shape, nodes, neck, fundus, liver_side, wall, bile, held, looks, extensions, compared_with,
         injury, keep_clear, vessels] = definition;
  visit(name, shape, nodes, neck, fundus, liver_side, wall, bile, held, looks, extensions, compared_with,
        injury, keep_clear, vessels);
}
void visit_members(auto&& visit, MembersOf<WallVessel> auto& definition) {
  auto& [points, radius] = definition;
  visit(points, radius);
}
void visit_members(auto&& visit, MembersOf<JointDefinition> auto& definition) {
  auto& [from, to, radius, stiffness] = definition;
  visit(from, to, radius, stiffness);
}
void visit_members(auto&& visit, MembersOf<TissueDefinition> auto& definition) {
  auto& [name, from, to, within, start, stop, strands, slack, stiffness, stiffening, strength, break_energy,
         density, radius, divide_energy, covered, looks] = definition;
  visit(name, from, to, within, start, stop, strands, slack, stiffness, stiffening, strength, break_energy,
        density, radius, divide_energy, covered, looks);
}
void visit_members(auto&& visit, MembersOf<LeafDefinition> auto& definition) {
  auto& [from, to, start, stop, free_edge, goes_on] = definition;
  visit(from, to, start, stop, free_edge, goes_on);
}
void visit_members(auto&& visit, MembersOf<GroundDefinition> auto& definition) {
  auto& [name, type, point, normal, to, size, radius, friction, looks, injury, thrust_limit] = definition;
  visit(name, type, point, normal, to, size, radius, friction, looks, injury, thrust_limit);
}
void visit_members(auto&& visit, MembersOf<SupportDefinition> auto& definition) {
  auto& [point, normal, friction] = definition;
  visit(point, normal, friction);
}
void visit_members(auto&& visit, MembersOf<AnatomyDefinition> auto& definition) {
  auto& [organs, joints, tissue, leaves, ground, support, friction, rest_within, heart_rate, table_head_up,
         table_left_down] = definition;
  visit(organs, joints, tissue, leaves, ground, support, friction, rest_within, heart_rate, table_head_up,
        table_left_down);
}
void visit_members(auto&& visit, MembersOf<PortDefinition> auto& definition) {
  auto& [name, position] = definition;
  visit(name, position);
}
void visit_members(auto&& visit, MembersOf<InstrumentDefinition> auto& definition) {
  auto& [name, type, port, force_limit, pinch_force, pad_friction, friction, power, clip, clips, bore,
         bore_length, suction, pinhole, waits, hand_force, port_friction] = definition;
  visit(name, type, port, force_limit, pinch_force, pad_friction, friction, power, clip, clips, bore,
        bore_length, suction, pinhole, waits, hand_force, port_friction);
}
void visit_members(auto&& visit, MembersOf<LaparoscopeDefinition> auto& definition) {
  auto& [port, angle, field_of_view, look_at, distance, light, exposure, horizon, show_structure] =
      definition;
  visit(port, angle, field_of_view, look_at, distance, light, exposure, horizon, show_structure);
}
void visit_members(auto&& visit, MembersOf<SolverDefinition> auto& definition) {
  auto& [rate, motion, tolerance, extension_levels, extension_scheme, extension_view, skip_still] =
      definition;
  visit(rate, motion, tolerance, extension_levels, extension_scheme, extension_view, skip_still);
}
void visit_members(auto&& visit, MembersOf<SceneDefinition> auto& definition) {
  auto& [anatomy, ports, instruments, laparoscope, solver] = definition;
  visit(anatomy, ports, instruments, laparoscope, solver);
}

}  // namespace calot
