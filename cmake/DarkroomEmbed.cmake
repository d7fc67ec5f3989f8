# cmake -DOUTPUT=FILE -DFOLDER=FOLDER -DPREFIX=PREFIX -DFILES=NAME,... -P DarkroomEmbed.cmake: writes a C++ initialiser
# {"PREFIX NAME", R"(text)"} for each file of the folder. Run by darkroom_embed() when one of them changes.
set(rows "")
string(REPLACE "," ";" FILES "${FILES}")
foreach(file ${FILES})
  file(READ "${FOLDER}/${file}" text)
  # Each kernel's text is read and hashed while a program waits: what only people read of it stays here.
  if(file MATCHES "\\.glsl$")
    string(REGEX REPLACE "\n[ \t]*//[^\n]*" "\n" text "\n${text}")
    string(SUBSTRING "${text}" 1 -1 text)
  endif()
  string(APPEND rows "    {\"${PREFIX}${file}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "${rows}")
