/* SPDX-License-Identifier: MIT
 *
 * calls.inl - the library's calls as Python sees them: name, arguments (module.c), what is returned, and the call itself:
 * p[k], n[k], d[k] are argument k, e the error. Included by module.c.
 */
/* clang-format off */
/* shapes */
CALL(build_circle, "radius:double out:>narc_arc", COUNT, narc_build_circle(d[0], p[1], &f->count, e))
CALL(build_capsule, "length:double radius:double out:>narc_arc", COUNT, narc_build_capsule(d[0], d[1], p[2], &f->count, e))
CALL(build_segment, "ends:<narc_point radius:double out:>narc_arc", COUNT, n[0] == 2
     ? narc_build_segment(p[0], (narc_point *)p[0] + 1, d[1], p[2], &f->count, e) : NARC_ERROR_COUNT)
CALL(build_box, "width:double height:double radius:double out:>narc_arc", COUNT, narc_build_box(d[0], d[1], d[2], p[3], &f->count, e))
CALL(build_polygon, "points:<narc_point radius:double out:>narc_arc", COUNT, narc_build_polygon(p[0], n[0], d[1], p[2], &f->count, e))
CALL(build_skin_polygon, "points:<narc_point radius:double out:>narc_arc", COUNT, narc_build_skin_polygon(p[0], n[0], d[1], p[2], &f->count, e))
CALL(build_regular_polygon, "corners:size circumradius:double radius:double out:>narc_arc", COUNT, narc_build_regular_polygon(n[0], d[1], d[2], p[3], &f->count, e))
CALL(build_ellipse, "half_x:double half_y:double arc_count:size out:>narc_arc", COUNT, narc_build_ellipse(d[0], d[1], n[2], p[3], &f->count, NULL, e))
CALL(build_points, "points:<narc_point radius:double out:>narc_arc", COUNT, narc_build_points(p[0], n[0], d[1], p[2], &f->count, e))
CALL(build_ring, "points:<narc_point out:>narc_arc", COUNT, narc_build_ring(p[0], n[0], p[1], &f->count, e))
CALL(center_arcs, "arcs:<narc_arc out:>narc_arc", COUNT, narc_center_arcs(p[0], f->count = n[0], p[1], NULL, e))
CALL(mirror_arcs, "arcs:<narc_arc out:>narc_arc", COUNT, narc_mirror_arcs(p[0], f->count = n[0], p[1], e))
CALL(move_arcs, "arcs:<narc_arc x:double y:double angle:double scale:double out:>narc_arc", COUNT, narc_move_arcs(p[0], f->count = n[0], d[1], d[2], d[3], d[4], p[5], e))
CALL(compute_mass, "arcs:<narc_arc out:>narc_mass", COUNT, MUST(narc_compute_mass(p[0], n[0], p[1])))
CALL(compute_union_mass, "arcs:<narc_arc counts:<8 out:>narc_mass", COUNT, narc_compute_union_mass(p[0], p[1], n[1], NULL, p[2], e))
CALL(compute_bounding_circle, "arcs:<narc_arc out:>narc_circle", COUNT, MUST(narc_compute_bounding_circle(p[0], n[0], p[1])))
CALL(compute_inscribed_circle, "arcs:<narc_arc out:>narc_circle", COUNT, MUST(narc_compute_inscribed_circle(p[0], n[0], p[1])))
CALL(compute_perimeter, "arcs:<narc_arc out:>8", COUNT, MUST(narc_compute_perimeter(p[0], n[0], p[1])))
CALL(add_shape, "shapes:Shapes! arcs:<narc_arc out:>4", COUNT, narc_add_shape(p[0], p[1], n[1], p[2], e))
CALL(replace_shape, "shapes:Shapes! shape:size arcs:<narc_arc", COUNT, narc_replace_shape(p[0], (uint32_t)n[1], p[2], n[2], e))
CALL(remove_shape, "shapes:Shapes! shape:size", COUNT, narc_remove_shape(p[0], (uint32_t)n[1], e))
CALL(count_shapes, "shapes:Shapes", COUNT, (f->count = narc_count_shapes(p[0]), NARC_OK))
CALL(count_uses, "shapes:Shapes shape:size", COUNT, (f->count = narc_count_uses(p[0], (uint32_t)n[1]), NARC_OK))
CALL(shape_flags, "shapes:Shapes shape:size", COUNT, (f->count = narc_shape_flags(p[0], (uint32_t)n[1]), NARC_OK))
CALL(get_arcs, "shapes:Shapes shape:size out:>narc_arc", COUNT, (f->count = n[2] < NARC_MAX_ARCS ? 0 : narc_get_arcs(p[0], (uint32_t)n[1], p[2]), NARC_OK))
CALL(count_saved_bytes, "shapes:Shapes", COUNT, (f->count = narc_count_saved_bytes(p[0]), NARC_OK))
CALL(save_shapes, "shapes:Shapes out:>1", COUNT, narc_save_shapes(p[0], p[1], n[1], e))
CALL(load_shapes, "shapes:Shapes! bytes:<1", COUNT, load_shapes(f->handles[0], p[1], n[1], e))
CALL(add_chain, "shapes:Shapes! arcs:<narc_arc options:narc_chain_options out:>narc_chain_entry", COUNT, narc_add_chain(p[0], p[1], n[1], p[2], p[3], n[3], &f->count, e))
/* bodies and pairs */
CALL(compute_poses, "angles:<4 cosine:>4 sine:>4", COUNT, n[1] == n[0] && n[2] == n[0] ? narc_compute_poses(p[0], n[0], p[1], p[2], e) : NARC_ERROR_COUNT)
CALL(validate_bodies, "shapes:Shapes bodies:narc_bodies@B", COUNT, narc_validate_bodies(p[0], p[1], e))
CALL(compute_boxes, "shapes:Shapes bodies:narc_bodies@B options:narc_box_options@B out:>narc_box@B", COUNT, narc_compute_boxes(p[0], p[1], p[2], p[3], e))
CALL(find_pairs, "broad:BroadPhase! boxes:<narc_box@B filter:narc_pair_filter@B threads:threads out:>8", COUNT, narc_find_pairs(p[0], p[1], n[1], p[2], p[3], p[4], p[4] ? (uint32_t *)p[4] + 1 : NULL, 8, n[4], &f->count, e))
CALL(place_parts, "owners:narc_bodies@B parts:narc_bodies@P owner:narc_index_column@P threads:threads out:>narc_body@P", COUNT, narc_place_parts(p[0], p[1], p[2], p[3], p[4], e))
CALL(find_overlaps, "shapes:Shapes bodies:narc_bodies@B pairs:narc_pairs@P query:narc_query@P out:>8@W", COUNT, narc_find_overlaps(p[0], p[1], p[2], p[3], p[4], e))
CALL(find_separations, "shapes:Shapes bodies:narc_bodies@B pairs:narc_pairs@P query:narc_query@P out:>4@P", COUNT, narc_find_separations(p[0], p[1], p[2], p[3], p[4], e))
CALL(find_contacts, "shapes:Shapes bodies:narc_bodies@B pairs:narc_pairs@P query:narc_query@P out:>narc_contact", COUNT, narc_find_contacts(p[0], p[1], p[2], p[3], p[4], n[4], &f->count, e))
CALL(find_manifolds, "shapes:Shapes bodies:narc_bodies@B pairs:narc_pairs@P query:narc_query@P out:>narc_manifold", COUNT, narc_find_manifolds(p[0], p[1], p[2], p[3], p[4], n[4], &f->count, e))
/* a step */
CALL(update_contacts, "contacts:Contacts! shapes:Shapes bodies:narc_bodies@B step:narc_step@B", STEP, update_contacts(p, &f->step, e))
CALL(forget_bodies, "contacts:Contacts! ids:<8", COUNT, narc_forget_bodies(p[0], p[1], n[1], e))
CALL(forget_contacts, "contacts:Contacts!", COUNT, (narc_forget_contacts(p[0]), NARC_OK))
CALL(count_contact_bytes, "contacts:Contacts", COUNT, (f->count = narc_count_contact_bytes(p[0]), NARC_OK))
CALL(save_contacts, "contacts:Contacts out:>1", COUNT, narc_save_contacts(p[0], p[1], n[1], e))
CALL(load_contacts, "contacts:Contacts! shapes:Shapes bytes:<1", STEP, narc_load_contacts(p[0], p[1], p[2], n[2], &f->step, e))
/* a scene */
CALL(build_index, "index:Index! boxes:<narc_box@B options:narc_index_options@B", COUNT, narc_build_index(p[0], p[1], n[1], p[2], e))
CALL(query_index, "index:Index! boxes:<narc_box@Q query:narc_index_query@Q", PAIRS, narc_query_index(p[0], p[1], n[1], p[2], &f->pairs, e))
CALL(cast_rays, "index:Index shapes:Shapes bodies:narc_bodies@B rays:narc_rays@Q options:narc_ray_options@Q out:>narc_ray_hit", COUNT, narc_cast_rays(p[0], p[1], p[2], p[3], p[4], p[5], n[5], e))
CALL(find_nearest, "index:Index shapes:Shapes bodies:narc_bodies@B points:narc_points@Q options:narc_nearest_options@Q out:>narc_distance", COUNT, narc_find_nearest(p[0], p[1], p[2], p[3], p[4], p[5], n[5], e))
CALL(find_distances, "shapes:Shapes bodies:narc_bodies@B points:narc_points@Q body:narc_index_column@Q threads:threads out:>narc_distance@Q", COUNT, narc_find_distances(p[0], p[1], p[2], p[3], p[4], p[5], e))
CALL(cast_pairs, "shapes:Shapes bodies:narc_bodies@B motions:narc_motions@B pairs:narc_pairs@P options:narc_cast_options@P out:>narc_impact", COUNT, narc_cast_pairs(p[0], p[1], p[2], p[3], NULL, p[4], p[5], n[5], e))
CALL(cast_shapes, "index:Index! shapes:Shapes bodies:narc_bodies@B movers:narc_bodies@Q motions:narc_motions@Q search:narc_index_query@Q options:narc_cast_options@Q out:>narc_impact", COUNT, narc_cast_shapes(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], n[7], e))
/* clang-format on */
