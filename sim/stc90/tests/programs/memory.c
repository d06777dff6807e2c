/* All memories, pointers to each of them, bits, recursion and jump tables. */
#include <8052.h>
#include <string.h>

__xdata __at(0x0200) unsigned char results[64];
static __xdata unsigned char far[128];
static __idata unsigned char upper[48];
static __data unsigned char lower[16];
static __code const char text[] = "A robot in a simulated home";
static __bit even, seen;
static unsigned char next;

static void keep(unsigned char value)
{
    results[next++] = value;
}

/* Through a pointer that can mean any memory. */
static unsigned char sum(unsigned char *bytes, unsigned char count)
{
    unsigned char total = 0;

    while (count--) {
        even = !even;
        total += even ? *bytes : (unsigned char)~*bytes;
        bytes++;
    }
    return total;
}

static unsigned int fibonacci(unsigned char n) __reentrant
{
    return n < 2 ? n : fibonacci(n - 1) + fibonacci(n - 2);
}

static unsigned char choose(unsigned char n)
{
    switch (n) {
    case 0: return 3;
    case 1: return 1;
    case 2: return 4;
    case 3: return 1;
    case 4: return 5;
    case 5: return 9;
    case 6: return 2;
    case 7: return 6;
    default: seen = 1; return 0;
    }
}

void main(void)
{
    unsigned char i;

    for (i = 0; i < sizeof far; i++)
        far[i] = i * 7;
    for (i = 0; i < sizeof upper; i++)
        upper[i] = far[i] ^ 0x5A;
    for (i = 0; i < sizeof lower; i++)
        lower[i] = upper[i] + text[i];
    memcpy(far + 64, (void *)text, sizeof text);
    memmove(far + 66, far + 64, 20);
    keep(sum(far, sizeof far));
    keep(sum(upper, sizeof upper));
    keep(sum(lower, sizeof lower));
    keep(sum((unsigned char *)text, sizeof text));
    keep(strlen((char *)text));
    keep(memcmp(far + 64, text, 4) != 0);
    for (i = 0; i < 10; i++)
        keep(choose(i));
    keep(seen);
    i = fibonacci(9);
    keep(i);
    for (;;)
        ;
}
