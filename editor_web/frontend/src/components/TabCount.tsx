/** How many there are of what a tab shows. */
import { Badge } from '@mantine/core'

export function TabCount({ count }: { readonly count: number }) {
  return (
    <Badge component="span" size="sm" ml="3xs" px="3xs" bg="var(--stopped-soft)" c="var(--stopped)">
      {count}
    </Badge>
  )
}
