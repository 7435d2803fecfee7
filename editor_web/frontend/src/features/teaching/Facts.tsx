/** What is known of something, each fact beside its name; numbers in columns. */
import { DataList } from '@mantine/core'
import type { ReactNode } from 'react'

interface Fact {
  readonly name: string
  readonly value: ReactNode
  readonly isCode?: boolean
}

/** Leaves out what is not known. */
export function Facts({ facts }: { readonly facts: readonly (Fact | false | undefined | null)[] }) {
  return (
    <DataList size="sm" gap={4} labelWidth="7em">
      {facts.map(
        (fact) =>
          fact && (
            <DataList.Item key={fact.name}>
              <DataList.ItemLabel>{fact.name}</DataList.ItemLabel>
              <DataList.ItemValue
                {...(fact.isCode && { ff: 'monospace', fz: 'xs' })}
                style={{ overflowWrap: 'anywhere', whiteSpace: fact.isCode ? 'pre-wrap' : undefined }}
              >
                {fact.value}
              </DataList.ItemValue>
            </DataList.Item>
          ),
      )}
    </DataList>
  )
}
