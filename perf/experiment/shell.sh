# Figure 22: a nucleus whose boundary is marked with fluorescence: the maxima of the intensity.
phantom shell
extract shell "$dir/shell.nrrd" --force gradient --gradient 0.1 --spring 0.2 --rest-length zero \
  --curvature 1.5

# The phantom's sphere has radius 0.36 of its 80 mm.
true_volume='(0.36 * 80 | . * . * .) * 4 / 3 * 3.14159265358979'
overview 22 \
  "One component with two holes, about 41,000 vertices." \
  "$(shape shell); volume off that of the phantom's sphere by $(number shell "(.surface.volume / ($true_volume) - 1) * 10000 | round / 100") %." \
  "A noisy spherical shell instead of a nucleus, without holes in truth and four times as small in vertices. The springs of null rest length, which draw the bubble onto the shell, still pull on it at rest: it comes out a little small, as the paper's must."
table "shell=f_gradI"
tile shell "by f_gradI" --azimuth 30 --elevation 20
picture shell 1
