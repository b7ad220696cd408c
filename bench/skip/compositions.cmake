# Compositions of bench/skip/main.cpp, from nothing to everything. bench/skip/run reads this list too.
set(compositions
  none point point_at_mass_centre point_friction region region_friction regions_friction regions_coupled regions_shape
  resolved resolved_friction)
