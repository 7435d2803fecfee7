/** What a tab of teaching shows, one below the other; it scrolls by itself where the page does not. */
import { Flex } from '@mantine/core'
import type { ReactNode } from 'react'

export function TabBody({ children }: { readonly children: ReactNode }) {
  return (
    <Flex direction="column" gap="sm" p="sm" h={{ base: 'auto', md: '100%' }} style={{ overflow: 'auto' }}>
      {children}
    </Flex>
  )
}
