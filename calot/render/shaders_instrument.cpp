#include "calot/render/shaders.h"

namespace calot::render::shaders {

const char* const kInstrumentVertex = R"(
layout(location = 0) in vec3 a_world;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_along;
layout(location = 3) in vec4 a_kind;   // metal, pale, mm along, turns around
out vec3 v_world;
out vec3 v_normal;
out vec3 v_along;
out vec4 v_kind;
invariant gl_Position;
void main() {
    v_world = a_world;
    v_normal = a_normal;
    v_along = a_along;
    v_kind = a_kind;
    gl_Position = u_view_projection * vec4(a_world, 1.0);
}
)";

const char* const kInstrumentFragment = R"(
in vec3 v_world;
in vec3 v_normal;
in vec3 v_along;
in vec4 v_kind;
uniform sampler3D u_smooth;
uniform sampler2D u_occlusion;
out vec4 o_colour;
void main() {
    float metal = v_kind.x, pale = v_kind.y;
    vec3 n = normalize(v_normal), view = normalize(u_eye.xyz - v_world);
    // Brushed along the wire: noise that is long along it and fine around it.
    float turn = 6.2831853 * v_kind.w;
    vec3 around = vec3(cos(turn), sin(turn), 0.0);
    vec4 brush = texture(u_smooth, vec3(around.xy * 0.35, v_kind.z * 0.012));
    vec4 wear = texture(u_smooth, vec3(around.xy * 0.06, v_kind.z * 0.05) + 0.37);
    vec3 across = cross(v_along, n);
    Material m;
    m.coat_normal = normalize(n + across * (0.22 * (brush.a - 0.5)) + v_along * (0.10 * (wear.a - 0.5)));
    m.normal = n;
    m.wrap = vec3(0.0);
    m.occlusion = 1.0;
#if QUALITY > 0
    m.occlusion = texture(u_occlusion, gl_FragCoord.xy * u_pixels.zw).r;
#endif
    // Insulation: black, slightly glossy plastic with scuffs; collar and sleeve: ivory ceramic, stained near the metal.
    vec3 dark = vec3(0.012, 0.012, 0.014) + 0.02 * smoothstep(0.62, 0.75, wear.a);
    vec3 ivory = mix(vec3(0.62, 0.57, 0.47), vec3(0.48, 0.40, 0.28), smoothstep(0.5, 0.75, wear.r));
    m.albedo = mix(dark, ivory, pale);
    m.rough = 0.38;
    m.specular = 0.04;
    m.coat = mix(0.55, 0.45, pale);
    m.coat_rough = 0.24 + 0.1 * wear.r;
    vec3 colour = light_material(m, v_world, false);
    if (metal > 0.0) {
        // Steel, tinted straw to blue by heat, dull where tissue has baked on.
        vec3 steel = mix(vec3(0.66, 0.65, 0.64), vec3(0.60, 0.53, 0.44), smoothstep(0.45, 0.75, wear.r));
        steel = mix(steel, vec3(0.30, 0.30, 0.38), 0.5 * smoothstep(0.56, 0.72, wear.g));
        float baked = smoothstep(0.60, 0.78, wear.b + 0.25 * (brush.a - 0.5));
        vec3 shine = vec3(0.0);
        for (int light = 0; light < 2; ++light) {
            vec3 to_light = u_light[light].xyz - v_world;
            float d2 = dot(to_light, to_light);
            vec3 h = normalize(to_light * inversesqrt(d2) + view);
            // Brushed metal spreads its highlight around the wire: half of the deviation across does not count.
            vec3 spread = normalize(h - 0.35 * dot(h, v_along) * v_along);
            float lobe = 0.7 * ggx(clamp(dot(m.coat_normal, spread), 0.0, 1.0), 0.36) + 0.5 * ggx(clamp(dot(m.coat_normal, h), 0.0, 1.0), 0.22);
            shine += u_light[light].w * scope_falloff(d2) * lobe * 0.30;
        }
        vec3 mirrored = reflect(-view, m.coat_normal);
        vec3 around_it = 0.8 * mix(surroundings(mirrored), vec3(dot(surroundings(mirrored), vec3(0.33))), 0.55) + vec3(0.16, 0.15, 0.145) * smoothstep(0.0, 1.0, -dot(mirrored, u_axis.xyz));
        float rim = pow(1.0 - clamp(dot(n, view), 0.0, 1.0), 5.0);
        vec3 bright = (shine + around_it) * (steel + (1.0 - steel) * rim) * (0.45 + 0.55 * m.occlusion);
        vec3 to_spark = u_spark.xyz - v_world;
        bright += u_spark.w * vec3(1.0, 0.6, 0.3) * steel * 6.0e-7 / (dot(to_spark, to_spark) + 5.0e-7);
        bright = mix(bright, 0.28 * bright * vec3(0.8, 0.55, 0.38), 0.8 * baked);
        colour = mix(colour, bright, metal);
    }
    o_colour = vec4(encode(colour), 1.0);
}
)";

// Drops of blood and water: billboards that look like small spheres.
const char* const kDropVertex = R"(
layout(location = 0) in vec4 a_place;    // position, radius [m]
layout(location = 1) in vec4 a_stretch;  // direction on the screen, length, 1 = water
out vec2 v_corner;
flat out float v_water;
void main() {
    v_corner = vec2(float((gl_VertexID & 1) * 2) - 1.0, float(gl_VertexID & 2) - 1.0);
    v_water = a_stretch.w;
    vec2 along = a_stretch.xy;
    vec2 offset = along * v_corner.x * (1.0 + a_stretch.z) + vec2(-along.y, along.x) * v_corner.y;
    vec4 clip = u_view_projection * vec4(a_place.xyz, 1.0);
    clip.xy += offset * a_place.w / u_projection.xy;
    gl_Position = clip;
}
)";

const char* const kDropFragment = R"(
in vec2 v_corner;
flat in float v_water;
out vec4 o_colour;
void main() {
    float r2 = dot(v_corner, v_corner);
    if (r2 > 1.0) discard;
    float up = sqrt(1.0 - r2);   // of the normal, towards the eye
    float shine = pow(clamp(dot(normalize(vec3(v_corner, up)), normalize(vec3(-0.35, 0.35, 0.87))), 0.0, 1.0), 60.0);
    vec3 blood = vec3(0.34, 0.010, 0.010) * (0.35 + 0.65 * up) + 0.9 * shine;
    vec3 water = vec3(0.75, 0.72, 0.70) * (0.10 + 0.25 * (1.0 - up)) + 1.1 * shine;
    float alpha = mix(0.96, 0.16 + 0.45 * (1.0 - up) + shine, v_water);
    alpha = clamp(alpha, 0.0, 1.0) * smoothstep(1.0, 0.8, r2);
    o_colour = vec4(encode(mix(blood, water, v_water)) * alpha, alpha);
}
)";

const char* const kSparkVertex = R"(
uniform float u_size;   // m
out vec2 v_corner;
void main() {
    v_corner = vec2(float((gl_VertexID & 1) * 2) - 1.0, float(gl_VertexID & 2) - 1.0);
    vec4 at = u_view * vec4(u_spark.xyz, 1.0);
    at.z += 0.0008;   // a little towards the eye, so that it is not buried in the tissue it burns
    vec3 world = (inverse(u_view) * (at + vec4(v_corner * u_size, 0.0, 0.0))).xyz;
    gl_Position = u_view_projection * vec4(world, 1.0);
}
)";

const char* const kSparkFragment = R"(
in vec2 v_corner;
out vec4 o_colour;
void main() {
    float r = length(v_corner);
    float angle = atan(v_corner.y, v_corner.x) + 7.0 * float(u_counts.y);
    float rays = 0.6 + 0.4 * sin(3.0 * angle) * sin(5.0 * angle + 1.3);
    float core = exp(-420.0 * r * r), halo = exp(-5.5 * r) * (1.0 - smoothstep(0.6, 1.0, r));
    vec3 light = u_spark.w * (core * vec3(5.0, 5.2, 6.5) + 0.22 * halo * rays * vec3(1.0, 0.48, 0.16));
    o_colour = vec4(encode(light), 0.0);
}
)";

const char* const kSmokeVertex = R"(
layout(location = 0) in vec4 a_place;    // position, radius [m]
layout(location = 1) in vec4 a_optics;   // optical depth through the middle, share of steam, age [s], seed 0..1
layout(location = 2) in vec4 a_stretch;  // direction on the screen, length
out vec2 v_corner;
out vec3 v_noise;
flat out vec4 v_optics;
flat out vec3 v_light;
out float v_axial;
void main() {
    vec2 corner = vec2(float((gl_VertexID & 1) * 2) - 1.0, float(gl_VertexID & 2) - 1.0);
    v_corner = corner;
    vec3 at = (u_view * vec4(a_place.xyz, 1.0)).xyz;
    vec2 along = a_stretch.xy;
    vec2 offset = along * corner.x * (1.0 + a_stretch.z) + vec2(-along.y, along.x) * corner.y / (1.0 + 0.35 * a_stretch.z);
    vec3 corner_at = at + vec3(offset * a_place.w, 0.0);
    v_axial = -at.z;
    v_noise = vec3(0.16 * offset + 7.3 * a_optics.w, fract(13.7 * a_optics.w) + 0.10 * a_optics.z);
    v_optics = a_optics;
    float light = 0.0;
    for (int k = 0; k < 2; ++k) {
        vec3 to_light = u_light[k].xyz - a_place.xyz;
        float d2 = dot(to_light, to_light);
        float aim = clamp(-dot(to_light, u_axis.xyz) * inversesqrt(d2), 0.0, 1.0);
        light += u_light[k].w * aim * aim * 2.0 / (1.0 + d2 / (u_axis.w * u_axis.w));
    }
    vec3 to_spark = u_spark.xyz - a_place.xyz;
    vec3 tint = mix(vec3(0.34, 0.35, 0.40), vec3(0.62, 0.61, 0.62), a_optics.y);   // smoke is bluish, steam white
    v_light = tint * min(light, 3.0) + u_spark.w * vec3(1.0, 0.6, 0.3) * 2.0e-6 / (dot(to_spark, to_spark) + 4.0e-6);
    vec4 clip = u_view_projection * vec4(a_place.xyz, 1.0);
    // Stay at the particle's depth: only x and y move over the billboard.
    clip.xy += offset * a_place.w / u_projection.xy;
    gl_Position = clip;
}
)";

const char* const kSmokeFragment = R"(
in vec2 v_corner;
in vec3 v_noise;
flat in vec4 v_optics;
flat in vec3 v_light;
in float v_axial;
uniform sampler3D u_smooth;
uniform sampler2D u_depth;
uniform vec4 u_smoke_pixels;   // 1 / size of this target in x, y; radius scale
out vec4 o_colour;
void main() {
    float r2 = dot(v_corner, v_corner);
    if (r2 > 1.0) discard;
    float behind = axial_m(texture(u_depth, gl_FragCoord.xy * u_smoke_pixels.xy).r) - v_axial;
    vec4 swirl = texture(u_smooth, v_noise);
    vec3 curled = v_noise + vec3(0.30 * (swirl.gb - 0.5), 0.0);
    vec4 wisp = texture(u_smooth, 1.5 * curled + vec3(0.0, 0.0, 0.31));
    float fall = max(0.0, exp(-3.0 * r2) - 0.0498) * 1.052;   // Gaussian, 0 at the rim
    // Torn by noise: thin sheets along its level lines stay, what lies between thins out with age.
    float sheet = 1.0 - 3.4 * abs(wisp.g - 0.5) - 0.8 * abs(wisp.a - 0.5);
    float torn = mix(0.15, 0.45, clamp(v_optics.z * 0.8, 0.0, 1.0));
    float density = fall * (0.10 + 2.6 * smoothstep(torn, 1.0, sheet));
    float soft = smoothstep(0.0, 0.004, behind) * smoothstep(0.012, 0.04, v_axial);
    float alpha = 1.0 - exp(-v_optics.x * density * soft);
    vec3 colour = v_light * (0.55 + 0.55 * wisp.r + 0.35 * fall);
    o_colour = vec4(encode(colour) * alpha, alpha);
}
)";

}  // namespace calot::render::shaders
