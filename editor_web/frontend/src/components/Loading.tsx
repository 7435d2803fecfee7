/** A view whose code may still be on its way, and may fail. */
import { Suspense, type ReactNode } from 'react'
import { ViewBoundary } from './ViewBoundary'

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
      <Suspense fallback={<div role="status" aria-label="Loading" />}>{children}</Suspense>
    </ViewBoundary>
  )
}
