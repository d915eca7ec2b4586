// Each part has one temperature: its Planck radiance was made in double precision.
Real sourceRadiance(int i) { return rows[draw_.table.x + uint(i)]; }
