# cmake -DOUTPUT=FILE -DFOLDER=FOLDER -DPREFIX=PREFIX -DFILES=NAME,... -P DarkroomEmbed.cmake: writes a C++ initialiser
# {"PREFIX NAME", R"(text)"} for each file of the folder. Run by darkroom_embed() when one of them changes.
set(rows "")
string(REPLACE "," ";" FILES "${FILES}")
foreach(file ${FILES})
  file(READ "${FOLDER}/${file}" text)
  string(APPEND rows "    {\"${PREFIX}${file}\", R\"embedded(${text})embedded\"},\n")
endforeach()
file(WRITE "${OUTPUT}" "${rows}")
