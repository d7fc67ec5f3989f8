// SPDX-License-Identifier: MIT
// Prints the size of every struct of Darkroom.java, and where its members begin, as JNA has them.

import com.sun.jna.Structure;
import java.lang.reflect.Method;

final class Layout {
    public static void main(String[] arguments) throws Exception {
        Method place = Structure.class.getDeclaredMethod("fieldOffset", String.class);
        place.setAccessible(true);
        for (Class<?> type : Darkroom.class.getDeclaredClasses()) {
            var order = type.getAnnotation(Structure.FieldOrder.class);
            if (order == null) continue;
            var struct = (Structure) type.getDeclaredConstructor().newInstance();
            System.out.println(type.getSimpleName() + " " + struct.size());
            for (String member : order.value())
                System.out.println(type.getSimpleName() + "." + member.replaceAll("_$", "") + " " + place.invoke(struct, member));
        }
    }
}
