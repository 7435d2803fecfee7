/** A view whose code may still be on its way, and may fail. */
import { WhileLoading } from './lazyView'
import { Text } from '@mantine/core'
import { useEffect, useState, type ReactNode } from 'react'
import { ViewBoundary } from './ViewBoundary'

/** What is there sooner says nothing: a word that comes and goes at once disturbs more than it tells. */
const SILENT_MS = 500

interface LoadingProps {
  /** What a failure calls it. */
  readonly name: string
  /** What it shows, where that changes. */
  readonly of?: string
  readonly children: ReactNode
}

export function Loading({ name, of = '', children }: LoadingProps) {
  return (
    <ViewBoundary name={name} of={of}>
      <WhileLoading value={<Waiting />}>{children}</WhileLoading>
    </ViewBoundary>
  )
}

function Waiting() {
  const [isLate, setLate] = useState(false)
  useEffect(() => {
    const timer = setTimeout(() => setLate(true), SILENT_MS)
    return () => clearTimeout(timer)
  }, [])
  return (
    <Text role="status" aria-label="Loading" p="md" c="dimmed">
      {isLate && 'Loading …'}
    </Text>
  )
}
