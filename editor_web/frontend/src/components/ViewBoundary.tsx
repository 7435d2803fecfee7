/** Keeps a view that fails from taking others with it: says what failed, tries again, hands out the details. */
import { Button, Code, Group, Stack, Text } from '@mantine/core'
import { QueryClientContext } from '@tanstack/react-query'
import { Component, useContext, useEffect, useState, type ErrorInfo, type ReactNode } from 'react'
import { forgetFailedLoads } from './lazyView'

interface ViewBoundaryProps {
  /** What it is called on the page, `Graph`. */
  readonly name: string
  /** What it shows; something else is tried although this has failed. */
  readonly of?: string
  readonly children: ReactNode
}

interface Failure {
  readonly error: unknown
  readonly stack: string
}

interface State {
  readonly failure: Failure | undefined
  readonly of: string
}

/** React tells of failures to classes only. */
export class ViewBoundary extends Component<ViewBoundaryProps, State> {
  override readonly state: State = { failure: undefined, of: '' }

  static getDerivedStateFromError(error: unknown): Partial<State> {
    return { failure: { error, stack: '' } }
  }

  static getDerivedStateFromProps({ of = '' }: ViewBoundaryProps, before: State): Partial<State> | null {
    return of === before.of ? null : { of, failure: undefined }
  }

  override componentDidCatch(error: unknown, { componentStack }: ErrorInfo): void {
    forgetFailedLoads()
    this.setState({ failure: { error, stack: componentStack ?? '' } })
  }

  override render(): ReactNode {
    const { failure } = this.state
    if (!failure) return this.props.children
    return <FailedView name={this.props.name} failure={failure} onAgain={() => this.setState({ failure: undefined })} />
  }
}

interface FailedViewProps {
  readonly name: string
  readonly failure: Failure
  readonly onAgain: () => void
}

function FailedView({ name, failure, onAgain }: FailedViewProps) {
  const [copied, setCopied] = useState<'no' | 'yes' | 'refused'>('no')
  const details = detailsOf(name, failure)
  const client = useContext(QueryClientContext)
  // An answer that cannot be shown is not shown again from the cache: it is asked for anew.
  useEffect(() => client?.removeQueries({ type: 'inactive' }), [client])

  function copy(): void {
    navigator.clipboard.writeText(details).then(
      () => setCopied('yes'),
      () => setCopied('refused'),
    )
  }

  return (
    <Stack
      component="section"
      role="alert"
      aria-label={`Failure of ${name}`}
      gap="2xs"
      px="md"
      py="sm"
      fz="sm"
      bg="var(--failed-soft)"
      style={{ borderInlineStart: '4px solid var(--failed)', overflow: 'auto', overflowWrap: 'anywhere' }}
    >
      <strong>{name} cannot be shown</strong>
      <Text inherit>{messageOf(failure.error)}</Text>
      <Group gap="3xs">
        <Button size="compact-sm" onClick={onAgain}>
          Try again
        </Button>
        <Button size="compact-sm" variant="default" onClick={copy}>
          {copied === 'yes' ? 'Copied' : 'Copy details'}
        </Button>
      </Group>
      <Text inherit>The rest of the page still works. Please report the details.</Text>
      {copied === 'refused' && <Code block>{details}</Code>}
    </Stack>
  )
}

function messageOf(error: unknown): string {
  return error instanceof Error ? `${error.name}: ${error.message}` : String(error)
}

function detailsOf(name: string, { error, stack }: Failure): string {
  const trace = error instanceof Error ? (error.stack ?? '') : ''
  return [`${name} at ${location.pathname}`, messageOf(error), trace, stack, navigator.userAgent].filter(Boolean).join('\n')
}
