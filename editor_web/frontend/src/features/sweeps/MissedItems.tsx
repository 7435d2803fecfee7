/** What no run of the sweep has executed: nodes that were never entered, exits that were never taken. */
import { List, Text } from '@mantine/core'
import type { CoverageItem } from '../../api/types'
import { Mono, Note } from './Note'

const FIRST = 60

export function MissedItems({ items, missing }: { readonly items: number; readonly missing: readonly CoverageItem[] }) {
  return (
    <>
      <Note>
        {items - missing.length} of {items} nodes and exits of the behavior were executed.
      </Note>
      {missing.length > 0 && (
        <List
          listStyleType="none"
          fz="0.8rem"
          mah="15rem"
          style={{ overflow: 'auto', overflowWrap: 'anywhere' }}
          aria-label="Never executed"
          tabIndex={0}
        >
          {missing.slice(0, FIRST).map((item) => (
            <li key={`${item.kind} ${item.path} ${item.name ?? ''} ${item.target ?? ''}`}>
              <Text span inherit c="dimmed">
                {item.kind.replace('_', ' ')}
              </Text>{' '}
              <Mono>{item.path}</Mono>
              {item.name && (
                <Mono>
                  {' '}
                  —{item.name}→ {item.target}
                </Mono>
              )}
            </li>
          ))}
          {missing.length > FIRST && (
            <Text component="li" inherit c="dimmed">
              and {missing.length - FIRST} more
            </Text>
          )}
        </List>
      )}
    </>
  )
}
