# cmake -DNM=... -DOBJECTS=FILE -DINNER=REGEX -DOUTPUT=FILE -P DarkroomExports.cmake: what a DLL exports, as a definition
# file, from the objects that FILE lists. The names that DarkroomLibrary.cmake has for other systems: left to itself the linker exports all there is, of fmt, too,
# and marking each declaration for the one system would say in every header what is said here once.
file(STRINGS ${OBJECTS} objects)
execute_process(COMMAND ${NM} --defined-only --extern-only ${objects} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
# Type and name. What is no text is data, which hosts reach without a jump.
string(REGEX MATCHALL "[A-Z] _Z(T[VTIS]|GV)?Z*NK?8darkroom[A-Za-z0-9_.$]*" symbols "${symbols}")
list(FILTER symbols EXCLUDE REGEX "^[A-Z] _Z(T[VTIS]|GV)?Z*NK?8darkroom(${INNER})")
list(REMOVE_DUPLICATES symbols)
list(SORT symbols)
list(TRANSFORM symbols REPLACE "^T (.*)$" "    \\1")
list(TRANSFORM symbols REPLACE "^[A-Z] (.*)$" "    \\1 DATA")
list(JOIN symbols "\n" symbols)
file(WRITE ${OUTPUT} "EXPORTS\n${symbols}\n")
