# Comments before a declaration, and those behind a field.
s|^\( *\)/\* |\1/** |
s|\([;,]\) */\* |\1 /**< |
# A line of a list of parameters: three spaces, the name, two spaces or more.
s|^ \*   \([a-z][a-z_]*\)  \+| * - `\1`: |
# Doxygen does not find the end of `a[0 .. n]`.
s|`\([^`]*\]\)`|\1|g
