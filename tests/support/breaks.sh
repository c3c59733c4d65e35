#!/usr/bin/env bash
# breaks.sh check: says which lines of the table below replace nothing any more, since the program has changed; status 2 then.
# breaks.sh [FOLDER [PATTERN]]: breaks the program on purpose, once for each line of the table below, and says whether the
# verification notices. Works on a copy of the sources, in FOLDER (default: a new one), and with PATTERN on the lines that match it only.
# Status 1 if a break goes unnoticed.
#
# A line: test of tests/verify (run on one rank) ; file ; sed expression ; what that means
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)

table() {
  cat <<'LINES'
dem_collision ; src/dem/demimpl.h ; s/- p->c_n \* m->overlap_rate; /- 0.99 * p->c_n * m->overlap_rate; / ; dashpot 1 % weaker
dem_plane ; src/dem/integrate.c ; s/(0.5 \* r\[i\] \* r\[i\])/(0.501 * r[i] * r[i])/ ; moment of inertia 0.2 % larger
dem_plane ; src/dem/demimpl.h ; s/p->mu_theta_r \* N, u/1.001 * p->mu_theta_r * N, u/ ; cap of the rolling moment 0.1 % higher
dem_incline ; src/dem/integrate.c ; s/(0.5 \* r\[i\] \* r\[i\])/(0.501 * r[i] * r[i])/ ; moment of inertia 0.2 % larger
dem_lattice ; src/dem/demimpl.h ; s/Friction(p->k_s,/Friction(1.01 * p->k_s,/ ; sliding stiffness 1 % higher
dem_biaxial ; src/dem/walls.c ; s/gain \* (w->stress \* length/gain * (1.02 * w->stress * length/ ; servo walls hold 2 % too much
dem_energy ; src/dem/demimpl.h ; s/(0.5 \* (before + after) + viscous) \* slip/(after + viscous) * slip/ ; friction takes the force of the end, not the mean
dem_tak ; src/dem/law_tak.c ; s/4\.0 \/ 3\.0 \* modulus/4.01 \/ 3.0 * modulus/ ; Hertz' force 0.25 % larger
dem_tak ; src/dem/law_tak.c ; s/(normal > p->R_n/(normal > 1.02 * p->R_n/ ; bonds 2 % stronger in tension
dem_tak ; src/dem/law_tak.c ; s/PetscAbsReal(tangential) > p->R_t/PetscAbsReal(tangential) > 1.02 * p->R_t/ ; bonds 2 % stronger in shear
dem_panel ; src/dem/integrate.c ; s/x\[i\] += dt \* v\[i\]/x[i] += dt * v[i] * (1 + 1e4 * dt)/ ; positions advance by 1e4 dt of their way too far, an error of first order
dem_lammps ; src/dem/contact_loop.c ; s/ny) + spin;/ny) + 0.9999 * spin;/ ; sliding by rotation 0.01 % less
dem_lammps ; src/dem/observables.c ; s/contact = value\[0\];/contact = 1.00001 * value[0];/ ; load 0.001 % higher, discs as they are
operator_mms ; src/sph/correction.c ; s/{my\[1\], -mx\[1\]}/{my[1], mx[1]}/ ; wrong sign in the inverse of the correction matrix
operator_mms ; src/sph/coefficient_loop.c ; s/= 2.0 \* f \* r2/= 2.01 * f * r2/ ; weights of the Laplacian 0.5 % larger
operator_mms ; src/sph/kernel.h ; s/return -5\.0 \* PG_QUINTIC/return -5.05 * PG_QUINTIC/ ; slope of the quintic spline 1 % larger
pressure_mms ; src/sph/coefficient_loop.c ; s/= 2.0 \* f \* r2/= 2.01 * f * r2/ ; weights of the Laplacian 0.5 % larger
predictor ; src/pore/step.c ; s/b00 = 1.0 + dt_f \* g\[0\]/b00 = 1.0 + 0.99 * dt_f * g[0]/ ; matrix B 1 % off in one place
water_bed_darcy ; src/pore/darcy.c ; s/s.v\[i\] - k_p \*/s.v[i] - 1.001 * k_p */ ; Darcy velocity 0.1 % larger
water_bed_ns ; src/pore/drag.c ; s/1\.75 \*/1.76 */ ; quadratic term of Ergun's law 0.6 % larger
water_bed_ns ; src/pore/navier_stokes.c ; s|pore->rho_f / (pore->theta \* dt_f)|pore->rho_f / dt_f| ; theta left out of Eq. 50
water_column ; src/pore/navier_stokes.c ; s/if (pressure) f -= V_p/if (pressure) f -= 0.999 * V_p/ ; buoyancy 0.1 % smaller
water_column ; src/pore/darcy.c ; s/(n + (pressure ? 1.0 - n : 0.0))/n/ ; seepage force on a plate without the pressure gradient
water_porosity ; src/pore/porosity.c ; s/PetscExpReal(-divergence\[a\] \* dt_f)/PetscExpReal(-1.01 * divergence[a] * dt_f)/ ; kinematic rate 1 % larger
water_porosity ; src/pore/porosity.c ; s/sample_radius = 4.0;/sample_radius = 4.001;/ ; sample circle 0.025 % wider
water_averaged ; src/pore/navier_stokes.c ; s/pore->a\[a\] + advected/pore->a[a] + 0.99 * advected/ ; term (u~ - v).grad n of the averaged continuity 1 % smaller
water_averaged ; src/pore/drag.c ; s/24\.0 \* (1\.0 + 0\.15/24.0 * (1.0 + 0.1501/ ; coefficient 0.15 of Wen and Yu 0.07 % larger
water_averaged ; src/pore/drag.c ; s/PetscPowReal(n, -2\.65)/PetscPowReal(n, -2.651)/ ; power 2.65 of the porosity 0.04 % larger
water_terzaghi ; src/pore/poreimpl.h ; s/if (s->plate\[a\] == 0.0) return PETSC_TRUE;/if (s->plate[a] == 0.0) return PETSC_FALSE;/ ; no added mass in the equation of free discs
water_terzaghi ; src/pore/darcy.c ; s/return dt_f \/ ((1.0/return 0.9 * dt_f \/ ((1.0/ ; mobility of the discs 10 % smaller
water_terzaghi ; src/pore/darcy.c ; s/+= pore->n_flow\[a\] \*/+= 0.98 * pore->n_flow[a] */ ; share n div v of the mass balance 2 % smaller
water_panel ; src/dem/integrate.c ; s/x\[i\] += dt \* v\[i\]/x[i] += dt * v[i] * (1 + 1e4 * dt)/ ; positions advance by 1e4 dt of their way too far, an error of first order
water_panel ; src/simulation/step.c ; s/dt_f = sim->dt \* (PetscReal)sim->fluid_every;/dt_f = sim->dt * (PetscReal)(sim->fluid_every + (sim->fluid_every > 1));/ ; fluid step of M + 1 steps of the discs, for M > 1
bodies_alone ; src/bodies/element.c ; s/(2 \* p\[i\] + p\[j\]) \/ 6/(2 * p[i] + p[j]) \/ 6.01/ ; integrals of Q 0.2 % off at one end of the edges
bodies_alone ; src/bodies/element.c ; s/S\[2\] = 2 \* b->G \* e\[2\];/S[2] = 2.02 * b->G * e[2];/ ; shear stress of bodies 1 % too large
bodies_alone ; src/bodies/step.c ; s/+ 0.5 \* dt \* dt \* b->a\[i\]/+ 0.25 * dt * dt * b->a[i]/ ; Eq. 50 with dt^2/4
bodies_collision ; src/bodies/couple.c ; s/b->force\[2 \* node\[n\] + d\] += b->N\[4 \* i + n\]/b->force[2 * node[n] + d] += 0.25/ ; forces of particles handed to all nodes alike
up_consolidation ; src/fem/material.c ; s/(m->alpha - m->n) \/ m->K_s/m->alpha \/ m->K_s/ ; storage of the grains without the porosity taken off
up_consolidation ; src/fem/element.c ; s/c->D \* (-grad\[i\] + c->rho_f \* gravity\[i\])/0.99 * c->D * (-grad[i] + c->rho_f * gravity[i])/ ; Darcy's law of the continuum 1 % weaker
up_consolidation ; src/fem/step.c ; s/load\[plate->master_local\] += all/load[plate->master_local] += 0.99 * all/ ; forces under a plate 1 % off
up_stability ; src/fem/system.c ; s/fem->stabilisation \/ M/0.99 * fem->stabilisation \/ M/ ; pressure projection 1 % weaker
up_footing ; src/fem/loads.c ; s/(N\[e\] - 0.5 \* bubble)/(N[e] - 0.45 * bubble)/ ; loads of Q2 edges wrong at their ends
up_footing ; src/fem/element.c ; s/v->stress\[2\]  *= c->G \* e\[2\]/v->stress[2] = 1.02 * c->G * e[2]/ ; shear stress 2 % too large
up_footing ; src/fem/loads.c ; s/ds = (to - from) \* weight/ds = weight/ ; load of a side that is loaded in part over its whole length
up_zones ; src/fem/system.c ; s/= PgFemStorage(m)/= 100.0 * PgFemStorage(m)/ ; water and grains a hundred times softer
up_inertia ; src/fem/step.c ; s/- (1.0 - theta) \/ theta \* a;/- 0.98 * (1.0 - theta) \/ theta * a;/ ; old acceleration 2 % off in the trapezoidal rule
up_solver ; src/fem/solver.c ; s/"-up_fieldsplit_u_pc_type", "hypre"/"-up_fieldsplit_u_pc_type", "jacobi"/ ; displacements preconditioned by Jacobi
up_solver ; src/fem/solver.c ; s/STIFF_RATIO 30.0/STIFF_RATIO 3e9/ ; multigrid for the displacements of a skeleton that keeps its volume
wcsph_energy ; src/wcsph/density.c ; s/PG_WCSPH_MIRROR ? 2\.0/PG_WCSPH_MIRROR ? 1.99/ ; volume of walls counts 0.5 % less than their pressure does
wcsph_energy ; src/wcsph/density.c ; s/sum += share \* (w->weight/sum += 0.99 * share * (w->weight/ ; adjoint walls give 1 % of their volume to nobody
wcsph_flows ; src/wcsph/forces.c ; s/(2\.0 \* w->mu/(2.01 * w->mu/ ; viscosity 0.5 % larger
wcsph_flows ; src/wcsph/solids.c ; s/2\.0 \* v - mean\[d\] \/ sum/2.0 * v - 0.9 * mean[d] \/ sum/ ; walls let the liquid slip by 5 %
wcsph_rest ; src/wcsph/forces.c ; s/+ PgDot(PgTwo(w->gravity, 0), PgWcsphR(f, k, i))/+ 0.0/ ; pressure of walls without the weight of the liquid between
wcsph_rest ; src/wcsph/density.c ; s/= -2\.0 \* w->delta/= -1.8 * w->delta/ ; diffusion of density 10 % weaker
LINES
}

# FILE EXPRESSION: what the file becomes
broken() { sed -e "$(sed 's/^ *//; s/ *$//' <<<"$2")" "$1"; }

if [ "${1:-}" = check ]; then
  stale=0
  while IFS=';' read -r test file rest; do
    file=${file// /}
    if broken "$source/$file" "${rest%;*}" | cmp -s "$source/$file" -; then
      echo "$file: nothing replaced by ${rest%;*}" >&2
      stale=2
    fi
  done < <(table)
  exit $stale
fi

folder=${1:-$(mktemp -d)}
pattern=${2:-.}
mkdir -p "$folder/source" "$folder/log"
for part in CMakeLists.txt include src tests options docs; do cp -R "$source/$part" "$folder/source/"; done
for part in "$source"/*; do [ -e "$folder/source/$(basename "$part")" ] || [ -d "$part/CMakeFiles" ] || cp -R "$part" "$folder/source/"; done
cmake -S "$folder/source" -B "$folder/build" -DCMAKE_BUILD_TYPE=Release >"$folder/log/configure"

echo "| test | break | noticed |"
echo "| --- | --- | --- |"
unnoticed=0
number=0
while IFS=';' read -r test file rest; do
  # the sed expression may hold semicolons: the meaning is what follows the last one
  meaning=${rest##*;}
  expression=${rest%;*}
  test=${test// /} file=${file// /}
  number=$((number + 1))
  cp "$folder/source/$file" "$folder/whole"
  broken "$folder/whole" "$expression" >"$folder/source/$file"
  if cmp -s "$folder/whole" "$folder/source/$file"; then
    echo "$file: nothing replaced by $expression" >&2
    exit 2
  fi
  target=porograin
  [ ! -f "$source/tests/verify/$test.c" ] || target="test-verify-$test"
  cmake --build "$folder/build" --target "$target" >"$folder/log/$number.build" 2>&1 </dev/null || {
    tail -n 5 "$folder/log/$number.build" >&2
    exit 2
  }
  if ctest --test-dir "$folder/build" -R "^verify.$test(.np1)?\$" --output-on-failure >"$folder/log/$number.test" 2>&1 </dev/null; then
    noticed=no
    unnoticed=1
  elif grep -Eq 'ERROR: .*(instead of|is not between|order|expected)|FAIL:' "$folder/log/$number.test"; then
    noticed=yes
  else
    noticed="yes: the run is stopped"
  fi
  echo "| \`$test\` |$meaning | $noticed |"
  cp "$folder/whole" "$folder/source/$file"
done < <(table | grep -E "$pattern")
exit $unnoticed
